"""readers.py ROOT [FIELD ...]: an error names each field of a message that no source reads: one that is only written need
not be sent. A reader takes `.field`, `->field` or `::field` without giving it a value; who only passes on whole messages,
as logs do, is none. Further FIELDs are taken as if the messages had them."""
import re
import sys
from pathlib import Path

root = Path(sys.argv[1])
sys.dont_write_bytecode = True
sys.path.insert(0, str(root / "idl"))
from read_idl import Idl  # noqa: E402

PROGRAMS = ["common", "haptic_node", "deform_node", "render_node", "web_node", "ros_bridge", "tools", "drivers", "python"]
text = "\n".join(p.read_text() for top in PROGRAMS for p in sorted((root / top).rglob("*.[ch]*")) if p.is_file())
read = set(re.findall(r"(?:\.|->|::)(\w+)\b(?!\s*=[^=])", text))
fields = {f"{s.name}.{f.name}": f.name for s in Idl((root / "idl/palpate.idl").read_text()).structs() for f in s.fields}
fields |= {name: name for name in sys.argv[2:]}
unread = [place for place, name in fields.items() if name not in read]
print("\n".join(f"{place} has no reader" for place in unread))
sys.exit(1 if unread else 0)
