"""readers.py ROOT [MESSAGE.FIELD ...]: an error names each field of a message that no source reads: one that is only
written need not be sent. A reader takes `.field`, `->field` or `::field` without giving it a value, where it names the
message or its topic, or asks any message whether it has the field; who only passes on whole messages, as logs do, is none.
Further fields are taken as if the messages had them."""
import re
import sys
from pathlib import Path

root = Path(sys.argv[1])
sys.dont_write_bytecode = True
sys.path.insert(0, str(root / "idl"))
from read_idl import Idl  # noqa: E402

PROGRAMS = ["common", "haptic_node", "deform_node", "render_node", "web_node", "ros_bridge", "tools", "drivers", "python"]
READ = re.compile(r"(?:\.|->|::)(\w+)\b(?!\s*=[^=])")
ASKED = re.compile(r"requires \{ \w+\.(\w+); \}")
# For whoever looks at a log with other tools: when it was, in the tissue's own time.
FOR_LOGS = {"TopologyChange.tissue_ns", "LocalContactModel.tissue_ns", "DeformKeyframe.tissue_ns"}

texts = [p.read_text() for top in PROGRAMS for p in sorted((root / top).rglob("*.[ch]*")) if p.is_file()]
sources = [(text, set(READ.findall(text))) for text in texts]
structs = Idl((root / "idl/palpate.idl").read_text()).structs()
asked = {name for text in texts for name in ASKED.findall(text)}


def names_of(struct):
    """What a source calls it by: its type, its topics, or a message that holds it."""
    holders = [s for s in structs if any(f.element == struct.name for f in s.fields)]
    return [struct.name] + [f"topics::{t.name}" for t in struct.topics] + [n for s in holders for n in names_of(s)]


def read_of(struct):
    named = re.compile("|".join(rf"\b{name}\b" for name in names_of(struct)))
    return {field for text, read_there in sources if named.search(text) for field in read_there}


read = {s.name: read_of(s) | asked for s in structs}
fields = [f"{s.name}.{f.name}" for s in structs for f in s.fields] + sys.argv[2:]
unread = [f for f in fields if f not in FOR_LOGS and f.split(".")[1] not in read[f.split(".")[0]]]
print("\n".join(f"{field} has no reader" for field in unread))
sys.exit(1 if unread else 0)
