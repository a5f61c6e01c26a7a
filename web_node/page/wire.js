// Messages between this page and web_node; docs/live.md has the layout. All numbers are little-endian.
export const SEEN = 1 << 31, OFFERED = 1 << 30, HOLDING = 1 << 29, UNHEARD = 1 << 28;
export const SILENT = 64;  // a ForceFlag: the tool is let go
export const SCENERY = 1, TOPOLOGY = 2, FRAME = 3;
const SAMPLE = 1, TAKE = 2, RELEASE = 3, GIVE = 4, TAKEN = 5, REST = 6;

const types = { f32: Float32Array, u32: Uint32Array, i32: Int32Array, u8: Uint8Array };

export function kindOf(buffer) {
  return new DataView(buffer).getUint32(0, true);
}

// JSON with arrays beside it: every {at, count, type} in it becomes a typed array.
export function decodeContainer(buffer) {
  const view = new DataView(buffer), length = view.getUint32(4, true);
  const json = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 8, length)));
  const begin = 8 + length;
  return resolve(json, (of) => new types[of.type](buffer, begin + of.at, of.count));
}

function resolve(value, array) {
  if (value === null || typeof value !== 'object') return value;
  if ('at' in value && 'count' in value) return array(value);
  for (const key of Object.keys(value)) value[key] = resolve(value[key], array);
  return value;
}

export function decodeFrame(buffer) {
  const view = new DataView(buffer);
  const frame = {
    topology: view.getUint32(4, true), sense: view.getFloat64(8, true), number: view.getUint32(16, true),
    latency: view.getFloat32(24, true), tools: [], bodies: [],
  };
  const tools = view.getUint16(20, true), bodies = view.getUint16(22, true);
  let at = 32;
  for (let i = 0; i < tools; ++i, at += 192) frame.tools.push(decodeTool(view, at));
  for (let i = 0; i < bodies; ++i) {
    const count = view.getUint32(at, true);
    const number = (k) => view.getFloat32(at + 4 + 4 * k, true);
    frame.bodies.push({
      low: [number(0), number(1), number(2)], step: [number(3), number(4), number(5)],
      words: new Uint16Array(buffer, at + 32, 3 * count),
    });
    at += 32 + 6 * count;
    at += (4 - at % 4) % 4;
  }
  return frame;
}

function decodeTool(view, at) {
  const f = (k) => view.getFloat32(at + 4 * k, true), u = (k) => view.getUint32(at + 4 * k, true);
  const parts = [0, 12, 24].map((p) => new Float32Array([  // column-major 4 x 4
    f(p), f(p + 4), f(p + 8), 0, f(p + 1), f(p + 5), f(p + 9), 0, f(p + 2), f(p + 6), f(p + 10), 0,
    f(p + 3), f(p + 7), f(p + 11), 1]));
  const flags = u(40);
  return {
    parts, force: [f(36), f(37), f(38)], gripTorque: f(39), flags: flags & 0xffff, seen: (flags & SEEN) !== 0,
    offered: (flags & OFFERED) !== 0, holding: (flags & HOLDING) !== 0, unheard: (flags & UNHEARD) !== 0,
    sample: u(41), holder: u(42), asker: u(43), roll: f(44), grip: f(45), pedal: f(46),
  };
}

// Positions [m] of one body into `to`, which is long enough.
export function unpack(body, to) {
  const { low, step, words } = body;
  for (let i = 0; i < words.length; i += 3) {
    to[i] = low[0] + step[0] * words[i];
    to[i + 1] = low[1] + step[1] * words[i + 1];
    to[i + 2] = low[2] + step[2] * words[i + 2];
  }
}

function short(kind, tool, number) {
  const view = new DataView(new ArrayBuffer(8));
  view.setUint8(0, kind);
  view.setUint8(1, tool);
  view.setUint32(4, number >>> 0, true);
  return view.buffer;
}
export const take = (tool) => short(TAKE, tool, 0);
export const release = (tool) => short(RELEASE, tool, 0);
export const give = (tool) => short(GIVE, tool, 0);
export const rest = () => short(REST, 0, 0);
export const taken = (count) => short(TAKEN, 0, count);

// tip [m], roll and grip [rad], pedal 0 or 1.
export function sample(tool, number, { tip, roll, grip, pedal }) {
  const view = new DataView(new ArrayBuffer(32));
  view.setUint8(0, SAMPLE);
  view.setUint8(1, tool);
  view.setUint32(4, number >>> 0, true);
  [...tip, roll, grip, pedal].forEach((value, k) => view.setFloat32(8 + 4 * k, value, true));
  return view.buffer;
}

// Numbers of two samples of the hand are so far apart: those between are of the first one's repetitions by the server.
export const numbersApart = 64;
