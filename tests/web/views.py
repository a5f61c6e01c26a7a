"""What the live view's camera and its buttons do to the picture, in headless Chromium."""
import math

from live_page import Nodes, Page, expect, open_page, open_small_browser, wait_for

GRID = (64, 48)  # squares of the picture that are looked at
HIGHER_THAN_WIDE = {"width": 420, "height": 760, "deviceScaleFactor": 1, "mobile": False}
# The scene stands, and pictures have one size.
STAND = """palpate.toggle('pause');
palpate.adapt = () => {};
palpate.scale = 0.5;
globalThis.complete = 0;
const made = palpate.made.bind(palpate);
palpate.made = (what) => { ++complete; made(what); };"""
# Colours of the picture, once one is complete that was begun after now, and in the page: two more are complete then.
LOOK = """const [columns, rows, done] = arguments;
let until;
requestAnimationFrame(() => requestAnimationFrame(() => { until = complete + 4; wait(); }));
function wait() {
  if (complete < until) return void setTimeout(wait, 10);
  const picture = document.getElementById('picture'), paper = document.createElement('canvas');
  paper.width = columns || picture.width;
  paper.height = rows || picture.height;
  const to = paper.getContext('2d');
  to.drawImage(picture, 0, 0, paper.width, paper.height);
  const { data } = to.getImageData(0, 0, paper.width, paper.height);
  if (columns) return void done([...data]);
  done(globalThis.places.flatMap(([x, y]) => [...data.slice(4 * (y * paper.width + x), 4 * (y * paper.width + x) + 4)]));
}"""


def look(page, grid=GRID):
    """Without a grid at the pixels `places`."""
    return page.browser.execute_async_script(LOOK, *(grid or (0, 0)))


def apart(one, other):
    """Mean difference of two pictures, of 255."""
    return sum(abs(a - b) for a, b in zip(one, other)) / len(one)


def greener(picture):
    """Share of it that is more green than red, as no tissue is."""
    return sum(g > r for r, g in zip(picture[::4], picture[1::4])) / (len(picture) / 4)


def added(a, b, by=1.0):
    return [x + by * y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    return [x / math.sqrt(dot(a, a)) for x in a]


def turned(v, axis, angle):
    """Right-handed about a unit axis (Rodrigues)."""
    c, s = math.cos(angle), math.sin(angle)
    return [c * v[i] + s * cross(axis, v)[i] + (1 - c) * dot(axis, v) * axis[i] for i in range(3)]


def drag(page, button, to):
    """From the middle of the picture by shares of its height, y downwards."""
    x, y = page.place(0.5, 0.5)
    height = page.get("document.getElementById('picture').clientHeight")
    held = {"left": 1, "right": 2, "middle": 4}[button]
    for kind, share, buttons in (("mousePressed", 0, held), ("mouseMoved", 0.5, held), ("mouseMoved", 1, held),
                                 ("mouseReleased", 1, 0)):
        page.browser.execute_cdp_cmd("Input.dispatchMouseEvent", {
            "type": kind, "x": x + share * to[0] * height, "y": y + share * to[1] * height, "button": button,
            "buttons": buttons, "clickCount": 1, "pointerType": "mouse"})


def wheel(page, notches):
    x, y = page.place(0.5, 0.5)
    page.browser.execute_cdp_cmd("Input.dispatchMouseEvent", {
        "type": "mouseWheel", "x": x, "y": y, "deltaX": 0, "deltaY": -100 * notches, "pointerType": "mouse"})


def orbited(eye, target, up, by):
    """What faces the camera goes the mouse's way: the camera goes the other, about its target."""
    back, up = added(eye, target, -1), unit(up)
    right = unit(cross(up, back))
    sideways = -3.5 * by[0]
    return added(target, turned(turned(back, up, sideways), turned(right, up, sideways), -3.5 * by[1])), target


def panned(eye, target, up, by, half_height):
    """What is as far as the target stays under the mouse. `half_height`: of the picture, at distance 1."""
    back = added(eye, target, -1)
    right = unit(cross(up, back))
    high = 2 * half_height * math.sqrt(dot(back, back))
    by = added(added([0, 0, 0], right, -high * by[0]), unit(cross(back, right)), high * by[1])
    return added(eye, by), added(target, by)


# A page whose pictures never come.
NO_THREAD = "globalThis.Worker = class { addEventListener() {} postMessage() {} };"
SAYS_FORCES = """globalThis.palpate && (() => { const { canvas } = palpate.curve, { data } =
  canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
return /\\d m?N$/.test(document.querySelector('#forces b')?.textContent) && data.some((value) => value > 0); })()"""


NOTE_AT_CLOSE = """const [done] = arguments, { socket } = palpate.link;
socket.addEventListener('close', () => done(document.getElementById('note').textContent));
socket.close();"""


def preparing(browser, address):
    """Before its first picture a page says so, and what is felt; without a connection it prepares none."""
    on_load = browser.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": NO_THREAD})
    browser.get(address)
    expect(wait_for(browser, SAYS_FORCES, 20), "no forces before the first picture")
    note = browser.execute_script("return document.getElementById('note').textContent")
    expect(note.startswith("preparing the picture"), note)
    note = browser.execute_async_script(NOTE_AT_CLOSE)
    expect("preparing" not in note, f"without a connection: {note}")
    expect(browser.execute_script("return document.getElementById('legend').hidden"), "a scale without its colours")
    browser.execute_cdp_cmd("Page.removeScriptToEvaluateOnNewDocument", on_load)


# Size of the file that Save keeps, and its colours on the grid.
SAVED = """const [columns, rows, done] = arguments;
palpate.picture.file(palpate.camera).then(createImageBitmap).then((image) => {
  const paper = new OffscreenCanvas(columns, rows), to = paper.getContext('2d');
  to.drawImage(image, 0, 0, columns, rows);
  done([image.width, image.height, ...to.getImageData(0, 0, columns, rows).data]);
});"""


def camera(options):
    """Orbit, pan and zoom lead to the pictures of cameras computed here; the endoscope comes back to the scene's, whose
    width is in the picture; what is saved has the screen's pixels, however few are drawn."""
    with Nodes(options, "liver.toml") as nodes:
        browser = open_small_browser()
        try:
            browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", HIGHER_THAN_WIDE)
            preparing(browser, nodes.address)
            page = Page(browser, nodes.address)
            page.wait("palpate.frame.tools[0].seen", 30)
            page.wait("!document.getElementById('legend').hidden", 5)
            note = page.get("document.getElementById('note').textContent")
            expect("preparing" not in note, note)
            browser.execute_script(STAND)
            begin = look(page)
            now = page.get("palpate.camera.now")
            eye, target, up = now["eye"], now["target"], now["up"]
            half_height = page.get("palpate.picture.axes.halfHeight")
            half_width, wanted = page.get("palpate.picture.axes.halfWidth"), 4 / 3 * math.tan(math.radians(25))
            expect(abs(half_width / wanted - 1) < 1e-6, f"the scene is {wanted} wide at distance 1, and {half_width} seen")
            width, height, *saved = browser.execute_async_script(SAVED, *GRID)
            expect([width, height] == page.get("['clientWidth', 'clientHeight'].map((of) => palpate.picture.canvas[of])"),
                   (width, height))
            print(f"what is saved is {apart(saved, begin):.2f} from what is seen")
            expect(apart(saved, begin) < 3, "another picture is saved than is seen")
            expect(apart(look(page), begin) < 0.2, "the picture is another one after it was saved")
            back = added(eye, target, -1)
            for name, act, (to_eye, to_target) in (
                    ("orbit", lambda: drag(page, "right", (0.2, 0.1)), orbited(eye, target, up, (0.2, 0.1))),
                    ("pan", lambda: drag(page, "middle", (0.2, 0.1)),
                     panned(eye, target, up, (0.2, 0.1), half_height)),
                    ("zoom", lambda: wheel(page, 3), (added(target, back, math.exp(-0.36)), target))):
                act()
                seen = look(page)
                browser.execute_script("[palpate.camera.now.eye, palpate.camera.now.target] = arguments", to_eye,
                                       to_target)
                wanted = look(page)
                page.get("palpate.keys.e(true)")
                again = look(page)
                print(f"{name}: {apart(seen, begin):.1f} from the endoscope's picture, {apart(seen, wanted):.2f} from "
                      f"where it should lead, {apart(again, begin):.2f} when back")
                expect(apart(seen, begin) > 5, f"{name}: the picture stays")
                expect(apart(seen, wanted) < 0.2, f"{name}: another picture than it should be")
                expect(apart(again, begin) < 0.2, f"{name}: the endoscope does not come back")
            expect(not page.errors(), page.errors())
        finally:
            browser.quit()


# Pixels where vertices of the catheter lie that are at least 3 mm past the duct's ends.
PLACES_INSIDE = """const { axes, canvas: { width, height } } = palpate.picture, bodies = palpate.bodies();
const of = (finish) => bodies.find((body) => body.spec.finish === finish).position;
const duct = of('duct'), catheter = of('plastic'), [low, high] = [Math.min, Math.max].map((best) =>
  duct.reduce((found, value, i) => (i % 3 ? found : best(found, value)), duct[0]));
globalThis.places = [];
for (let i = 0; i < catheter.length; i += 3) {
  if (catheter[i] < low + 0.003 || catheter[i] > high - 0.003) continue;
  const d = [0, 1, 2].map((k) => catheter[i + k] - axes.eye[k]);
  const along = (axis) => d[0] * axis[0] + d[1] * axis[1] + d[2] * axis[2], far = along(axes.forward);
  places.push([Math.floor((0.5 + 0.5 * along(axes.right) / far / axes.halfWidth) * width),
    Math.floor((0.5 - 0.5 * along(axes.up) / far / axes.halfHeight) * height)]);
}
globalThis.places = places.filter(([x, y]) => x >= 0 && y >= 0 && x < width && y < height);
return places.length;"""
# The frame that is shown again and again, with the catheter a kilometre away.
CATHETER_IS_HIDDEN = """const { words } =
  palpate.frame.bodies[palpate.scenery.bodies.findIndex((body) => body.finish === 'plastic')];
const without = words.buffer.slice(), take = palpate.picture.take.bind(palpate.picture);
new DataView(without).setFloat32(words.byteOffset - 28, 1000, true);
palpate.picture.take = () => take(without);
palpate.picture.take();
palpate.toggle('pause');"""
# [mm] How far the catheter has gone, how far the duct, and where its colours end.
GONE = """(() => { const most = (finish) =>
  Math.max(...palpate.bodies().find((body) => body.spec.finish === finish).displacement);
return [most('plastic'), most('duct'), palpate.look.legendMax].map((metres) => 1e3 * metres); })()"""
INSERTED = "parseInt(document.querySelector('#tasks p')?.textContent) >= 5"  # [mm]


def through(options):
    """The catheter in the duct is in the picture where ducts are seen through, and only there; its way, which takes no
    colour, does not stretch the scale of the duct's."""
    with Nodes(options, "catheter_insertion.toml") as nodes, open_page(nodes) as page:
        page.wait(INSERTED, 60)
        page.browser.execute_script(STAND)
        look(page)
        catheter, duct, last_colour = page.get(GONE)
        print(f"the catheter has gone {catheter:.1f} mm, the duct {duct:.1f} mm; the last colour is {last_colour:.1f} mm")
        expect(duct <= last_colour < 0.5 * catheter, "the scale of colours is not the duct's")
        count = page.browser.execute_script(PLACES_INSIDE)
        expect(count > 30, f"{count} places of the catheter are in the duct")
        closed = look(page, None)
        page.get("palpate.keys.t(true)")
        clear = look(page, None)
        page.browser.execute_script(CATHETER_IS_HIDDEN)
        clear_without = look(page, None)
        page.get("palpate.keys.t(true)")
        closed_without = look(page, None)
        print(f"{count} places: the catheter makes {apart(clear, clear_without):.1f} in a clear duct, "
              f"{apart(closed, closed_without):.1f} in a closed one")
        expect(apart(clear, clear_without) > 8, "the catheter is not seen in a clear duct")
        expect(apart(closed, closed_without) < 1, "the catheter is seen in a closed duct")
        expect(not page.errors(), page.errors())
