"""Reads the annotated IDL, whose head says how it is annotated; what does not have the form is a Fault."""
import re
from dataclasses import dataclass, field

NUMBERS = {"unsigned long": "std::uint32_t", "unsigned long long": "std::uint64_t", "long long": "std::int64_t",
           "octet": "std::uint8_t", "float": "float", "double": "double"}


class Fault(Exception):
    def __init__(self, line, text):
        super().__init__(text)
        self.line = line


@dataclass
class Field:
    line: int
    name: str
    kind: str  # number, array, string, sequence
    element: str  # IDL type: of the number, of an element; empty for a string
    extent: str  # of an array; bound of a sequence or string
    key: bool
    unit: str
    frame: str
    limits: str
    meaning: str


@dataclass
class Struct:
    name: str
    comment: list
    fields: list = field(default_factory=list)
    topics: list = field(default_factory=list)

    def find(self, name):
        return next((f for f in self.fields if f.name == name), None)


@dataclass
class Topic:
    line: int
    name: str
    content: str
    cells: dict = field(default_factory=dict)


@dataclass
class Enum:
    name: str
    comment: list
    values: list = field(default_factory=list)  # (name, number, meaning)


@dataclass
class Const:
    name: str
    type: str
    value: str
    comment: list


class Idl:
    """An IDL file as read: `items` are its constants, enums and structs in order."""

    def __init__(self, text):
        self.module, self.roles, self.items = None, [], []
        self.block, self.at = [], 0  # comment lines above what comes, with their numbers; current line
        lines = iter(enumerate(text.splitlines(), 1))
        for self.at, line in lines:
            self.top(line, lines)
        if not self.module or not self.roles:
            raise Fault(1, "there is no line 'module NAME {' or none '// roles: ROLE, ROLE'")
        for struct in self.structs():
            list(conditions(self, struct))
        for topic in self.topics():
            qos(self, topic)
            roles_in(self, topic, "writers"), roles_in(self, topic, "readers")

    def of(self, kind):
        return [i for i in self.items if isinstance(i, kind)]

    def structs(self):
        return self.of(Struct)

    def struct_named(self, name):
        return next((s for s in self.structs() if s.name == name), Struct(name, []))

    def messages(self):
        return [s for s in self.structs() if s.topics]

    def topics(self):
        return [t for s in self.structs() for t in s.topics]

    def number(self, text):
        """The value of a constant, an enumerator or a literal; None if it is neither."""
        known = {c.name: c.value for c in self.of(Const)}
        known |= {name: str(number) for e in self.of(Enum) for name, number, _ in e.values}
        value = known.get(text, text)
        return value if re.fullmatch(r"-?\d+(\.\d+)?", value) else None

    def top(self, line, lines):
        if match := re.fullmatch(r"// roles: (.+)", line):
            self.roles = match[1].split(", ")
        elif line.startswith("//"):
            self.block.append((self.at, line[2:]))
            return
        elif match := re.fullmatch(r"module (\w+) \{", line):
            self.module = match[1]
        elif match := re.fullmatch(r"const ([\w ]+) (\w+) = (-?[\d.]+);", line):
            self.add(Const(match[2], match[1], match[3], self.words()))
            if match[1] not in NUMBERS:
                raise Fault(self.at, f"'{match[1]}' is no type of a number")
        elif match := re.fullmatch(r"enum (\w+) \{", line):
            self.enum(self.add(Enum(match[1], self.words())), lines)
        elif match := re.fullmatch(r"@final struct (\w+) \{", line):
            self.struct(match[1], lines)
        elif line not in ("", "};"):
            raise Fault(self.at, f"neither module, const, enum, @final struct nor comment: {line.strip()}")
        elif any(words.startswith(" topic ") for _, words in self.block):
            raise Fault(self.at, "a topic stands in the comment right above its struct")
        self.block = []

    def add(self, item):
        if not item.comment:
            raise Fault(self.at, f"{item.name} has no comment above it that says what it is")
        if item.name in [i.name for i in self.items]:
            raise Fault(self.at, f"{item.name} is there twice")
        self.items.append(item)
        return item

    def words(self):
        return [words.strip() for _, words in self.block]

    def enum(self, enum, lines):
        for self.at, line in lines:
            if line == "};":
                return
            match = re.fullmatch(r"  (?:@value\((\d+)\) )?(\w+),?\s*(?:// (.*))?", line)
            if not match:
                raise Fault(self.at, f"an enumerator of {enum.name} is '[@value(N)] name,', not: {line.strip()}")
            following = enum.values[-1][1] + 1 if enum.values else 0
            enum.values.append((match[2], int(match[1] or following), match[3] or ""))

    def struct(self, name, lines):
        end = next((i for i, (_, words) in enumerate(self.block) if words.startswith(" topic ")), len(self.block))
        struct = Struct(name, [words.strip() for _, words in self.block[:end] if words.strip()])
        struct.topics = self.read_topics(self.block[end:])
        self.add(struct)
        for self.at, line in lines:
            if line == "};":
                if not struct.fields:
                    raise Fault(self.at, f"{name} has no field")
                return
            if struct.fields and (match := re.fullmatch(r"\s+// (\S.*)", line)):
                struct.fields[-1].meaning += " " + match[1]
            else:
                struct.fields.append(self.read_field(struct, line))

    def read_topics(self, block):
        topics = []
        for at, words in block:
            if match := re.fullmatch(r" topic palpate/(\w+): (.+)", words):
                topics.append(Topic(at, match[1], match[2]))
                if match[1] in [t.name for t in self.topics() + topics[:-1]]:
                    raise Fault(at, f"the topic {match[1]} is there twice")
            elif match := re.fullmatch(r"   (delivery|rate|writers|readers) +(\S.*)", words):
                topics[-1].cells[match[1]] = match[2]
            elif words:
                raise Fault(at, f"in a topic stand delivery, rate, writers and readers, not: {words.strip()}")
        for topic in topics:
            for cell in ("delivery", "rate", "writers", "readers"):
                if cell not in topic.cells:
                    raise Fault(topic.line, f"the topic {topic.name} does not say its {cell}")
        return topics

    def read_field(self, struct, line):
        match = re.fullmatch(r"\s+(@key )?(\S.*?) (\w+)(?:\[(\d+)\])?;\s*"
                             r"// \[([^\]]+)\] \[([^\]]+)\] (?:\[([^\]]+)\] )?([^\s\[].*)", line)
        if not match:
            raise Fault(self.at, f"a field of {struct.name} is 'type name;  // [unit] [frame] [limits] meaning', "
                        f"the limits where it has some, not: {line.strip()}")
        key, idl_type, name, extent, unit, frame, limits, meaning = match.groups()
        sequence = re.fullmatch(r"sequence<([\w ]+), (\d+)>", idl_type)
        string = re.fullmatch(r"string(?:<(\d+)>)?", idl_type)
        known = list(NUMBERS) + [s.name for s in self.structs() if s is not struct]
        element = sequence[1] if sequence else "" if string else idl_type
        if not string and (element not in known or (not sequence and element not in NUMBERS)):
            raise Fault(self.at, f"{struct.name}.{name}: '{idl_type}' is no type that a field may have; sequences have "
                        "a bound, and a struct stands in a sequence, below its own definition")
        if any(f.kind in ("string", "sequence") for f in self.struct_named(element).fields):
            raise Fault(self.at, f"{struct.name}.{name}: a struct in a sequence has numbers and arrays alone")
        if extent and (sequence or string):
            raise Fault(self.at, f"{struct.name}.{name}: an array has numbers")
        if struct.find(name):
            raise Fault(self.at, f"{struct.name}.{name} is there twice")
        if key and (extent or sequence or not all(f.key for f in struct.fields)):
            raise Fault(self.at, f"{struct.name}.{name}: keys are numbers or strings and stand before the other fields")
        if element in ("float", "double") and unit == "-":
            raise Fault(self.at, f"{struct.name}.{name} has a unit, [1] at least")
        kind = "sequence" if sequence else "string" if string else "array" if extent else "number"
        bound = sequence[2] if sequence else string[1] if string else extent
        return Field(self.at, name, kind, element, bound or "", bool(key), unit, frame, limits or "", meaning)


def told_condition(idl, struct, f):
    """The C++ condition that the limits of a field come to, with `m` the message."""
    def refuse(why):
        raise Fault(f.line, f"{struct.name}.{f.name}: the limits '{f.limits}' {why}")

    def length(name, kinds):
        other = struct.find(name)
        if not other or other.kind not in kinds:
            refuse(f"name no {' or '.join(kinds)} of {struct.name}: {name}")
        return f"m.{name}.size()"

    def end(text):
        other = struct.find(text)
        if other and other.kind == "array":
            refuse(f"name an array: {text}")
        if other:
            return f"m.{text}" + (".size()" if other.kind != "number" else "")
        if idl.number(text) is None:
            refuse(f"name neither a number, a constant nor a field: {text}")
        return text

    def of_a(*kinds):
        if f.kind not in kinds:
            refuse(f"are for a {' or '.join(kinds)}")

    value = f"m.{f.name}" + (".size()" if f.kind in ("string", "sequence") else "")
    if match := re.fullmatch(r"([^\s.]\S*?)?\.\.(\S+)?", f.limits):
        of_a("number", "string", "sequence")
        low, high = match.groups()
        unsigned = f.kind != "number" or f.element.startswith("unsigned")
        parts = [f"{value} >= {end(low)}"] if low and not (low == "0" and unsigned) else []
        parts += [f"{value} <= {end(high)}"] if high else []
        return " && ".join(parts) or refuse("leave everything open")
    if match := re.fullmatch(r"above (\S+)", f.limits):
        of_a("number")
        return f"{value} > {end(match[1])}"
    if f.limits == "unit vector":
        if (f.kind, f.element, f.extent) != ("array", "double", "3"):
            refuse("are for a double[3]")
        return f"checks::unit(m.{f.name})"
    if match := re.fullmatch(r"multiple of ([1-9]\d*)", f.limits):
        of_a("sequence")
        return f"{value} % {match[1]} == 0"
    if match := re.fullmatch(r"as many as (\w+)", f.limits):
        of_a("sequence")
        return f"{value} == {length(match[1], ['sequence'])}"
    if match := re.fullmatch(r"indices of (\w+)", f.limits):
        inner = idl.struct_named(f.element)
        if f.kind != "sequence" or not inner.fields or any(g.element != "unsigned long" for g in inner.fields):
            refuse("are for a sequence of structs that hold unsigned longs alone")
        size = length(match[1], ["sequence"])
        parts = " && ".join(f"e.{g.name} < {size}" for g in inner.fields)
        return f"checks::each(m.{f.name}, [&](const auto& e) {{ return {parts}; }})"
    return refuse("are none that there are")


def conditions(idl, struct):
    """All conditions of a struct: those that the types bring and those that are told."""
    for f in struct.fields:
        if f.kind == "string":
            yield f"checks::short_enough(m.{f.name})"
        elif f.kind == "sequence":
            yield f"m.{f.name}.size() <= Limits<{struct.name}>::{f.name}"
        if f.limits:
            yield told_condition(idl, struct, f)
    for f in struct.fields:
        if f.element in ("float", "double"):
            yield f"checks::finite(m.{f.name})"
        elif f.element == "long long":
            yield f"checks::time(m.{f.name})"
        elif f.kind == "sequence" and any(conditions(idl, idl.struct_named(f.element))):
            yield f"checks::each(m.{f.name}, [](const auto& e) {{ return valid(e); }})"


def qos(idl, topic):
    """reliable, depth, transient local, depth for recorders; a depth of 0 keeps all."""
    match = re.fullmatch(r"(reliable|best effort), keeps ([1-9a-z]\w*)(?:, keeps ([1-9a-z]\w*) for recorders)?"
                         r"(?:, late joiners get (the newest|all))?", topic.cells["delivery"])
    depth = "0" if match and match[2] == "all" else match and idl.number(match[2])
    recorders = idl.number(match[3]) if match and match[3] else "0"
    if not match or depth is None or recorders is None or (match[4] == "all") != (match[2] == "all"):
        raise Fault(topic.line, f"the topic {topic.name}: delivery is 'reliable, keeps N' with what the head of the "
                    f"file allows, all for late joiners where all is kept, not: {topic.cells['delivery']}")
    return match[1] == "reliable", int(depth), match[4] is not None, int(recorders)


def roles_in(idl, topic, cell):
    """The roles that a cell names."""
    text = topic.cells[cell]
    if text in ("all", "none"):
        return idl.roles if text == "all" else []
    left_out = text.removeprefix("all but ")
    named = left_out.split(", ")
    for role in named:
        if role not in idl.roles:
            raise Fault(topic.line, f"the topic {topic.name}: its {cell} name '{role}', which is none of the roles "
                        f"{', '.join(idl.roles)}")
    return named if left_out == text else [r for r in idl.roles if r not in named]
