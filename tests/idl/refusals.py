"""refusals.py GENERATOR FOLDER ...: what the generator says of each folder's bad.idl, written to its file said."""
import os
import sys
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, sys.argv[1])
import generate  # noqa: E402

start = Path.cwd()
for folder in sys.argv[2:]:
    os.chdir(start / folder)
    said = ""
    try:
        generate.main("bad.idl", "written")
    except SystemExit as end:
        said = str(end)
    Path("said").write_text(said)
