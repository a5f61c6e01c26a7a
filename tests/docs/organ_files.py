"""What the lines of docs/organ.md begin with: a surface, a labelled image and one of grey values, each of its reader's own."""
import gzip
import math
import pathlib
import struct
import tarfile

PACKAGE = pathlib.Path("/usr/share/doc/libcgal-dev/data.tar.gz")  # of Debian's libcgal-demo: a real liver


def ellipsoid(x, y, z):
    """Less than 1 inside of an organ of 180 x 130 x 90 mm, in the image's millimetres."""
    return math.hypot((x - 100) / 90, (y - 75) / 65, (z - 55) / 45)


def write_surface(file):
    """Of the ellipsoid, in millimetres: a text STL."""
    rings, around = 24, 48

    def place(ring, turn):
        polar, angle = math.pi * ring / rings, 2 * math.pi * (turn % around) / around
        return (100 + 90 * math.sin(polar) * math.cos(angle), 75 + 65 * math.sin(polar) * math.sin(angle),
                55 + 45 * math.cos(polar))

    lines = ["solid liver"]
    for r in range(rings):
        for t in range(around):
            a, b, c, d = place(r, t), place(r + 1, t), place(r + 1, t + 1), place(r, t + 1)
            for triangle in ([(a, b, c)] if r < rings - 1 else []) + ([(a, c, d)] if r > 0 else []):
                lines += ["facet normal 0 0 0", "outer loop", *("vertex %f %f %f" % x for x in triangle), "endloop", "endfacet"]
    file.write_text("\n".join(lines + ["endsolid liver\n"]))


def write_labels(file):
    """The real liver where it is; otherwise the ellipsoid, and a ball of another label that lies in its side."""
    if PACKAGE.exists():
        with tarfile.open(PACKAGE) as package:
            file.write_bytes(package.extractfile("data/images/liver.inr.gz").read())
        return
    nx, ny, nz = 67, 50, 37
    header = (f"#INRIMAGE-4#{{\nXDIM={nx}\nYDIM={ny}\nZDIM={nz}\nVDIM=1\nTYPE=unsigned fixed\nPIXSIZE=8 bits\nCPU=decm\n"
              "VX=3\nVY=3\nVZ=3\n")
    voxels = bytearray()
    for z in range(0, 3 * nz, 3):
        for y in range(0, 3 * ny, 3):
            for x in range(0, 3 * nx, 3):
                gall_bladder = math.hypot(x - 120, y - 75, z - 14) < 13
                voxels.append(85 if gall_bladder else 255 if ellipsoid(x, y, z) < 1 else 0)
    file.write_bytes(gzip.compress(header.ljust(252, "\n").encode() + b"##}\n" + bytes(voxels)))


def write_grey_values(file):
    """A ball of 26 mm, of 120 in 60, about the page's seed: 60, -20, 110 mm to the left, to the back and to the head."""
    n = 40
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, n, n, n, 1, 1, 1, 1)
    struct.pack_into("<2h", header, 70, 4, 16)  # whole numbers of 16 bits
    struct.pack_into("<4f", header, 76, 1, 2, 2, 2)
    struct.pack_into("<2f", header, 108, 352, 1)
    struct.pack_into("<h", header, 254, 1)
    struct.pack_into("<12f", header, 280, -2, 0, 0, -20, 0, -2, 0, 60, 0, 0, 2, 70)  # to the right, the front, the head
    header[344:348] = b"n+1\0"
    values = [120 if math.dist((i, j, k), (20, 20, 20)) < 13 else 60 + (7 * i + 5 * j + 3 * k) % 11
              for k in range(n) for j in range(n) for i in range(n)]
    file.write_bytes(gzip.compress(bytes(header) + struct.pack(f"<{n ** 3}h", *values)))


def write_points(file):
    """A contour by hand in a slice of these."""
    turns = [2 * math.pi * i / 12 for i in range(12)]
    file.write_text("".join(f"20 {20 + 13 * math.cos(t):.2f} {20 + 13 * math.sin(t):.2f}\n" for t in turns))


def write_all(folder):
    write_surface(folder / "liver.stl")
    write_labels(folder / "liver.inr.gz")
    write_grey_values(folder / "ct.nii.gz")
    write_points(folder / "mended.txt")
