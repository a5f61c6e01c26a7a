#!/usr/bin/env python3
"""Writes the C++ of the messages from the annotated IDL, whose head says how it is annotated.

    generate.py MESSAGES.idl FOLDER           messages.hpp, fields.hpp, limits.hpp, limits.cpp, topics.hpp,
                                              dds_types.hpp, and topics.md, the table of topics
    generate.py MESSAGES.idl --page PAGE.md   puts that table between the page's two marks

What does not have the form is refused with a sentence FILE:LINE.
"""
import sys
from pathlib import Path

sys.dont_write_bytecode = True
from read_idl import NUMBERS, Const, Enum, Fault, Idl, conditions, qos, roles_in  # noqa: E402

MARKS = ("<!-- topics: begin, written by idl/generate.py -->\n", "<!-- topics: end -->\n")


def cpp_type(f):
    element = NUMBERS.get(f.element, f.element)
    return {"number": element, "string": "std::string", "array": f"std::array<{element}, {f.extent}>",
            "sequence": f"std::vector<{element}>"}[f.kind]


def doc(comment):
    return "".join(f"/// {line}\n" for line in comment)


def field_text(f):
    start = {"number": " = 0", "array": "{}"}.get(f.kind, "")
    marks = [f"[{mark}]" for mark in (f.unit, f.frame, f.limits or "-") if mark != "-"]
    return f"  {cpp_type(f)} {f.name}{start};  ///< {' '.join(['key:'] * f.key + marks + [f.meaning])}\n"


def messages(idl):
    text = "".join(f"#include <{header}>\n" for header in ("array", "cstdint", "string", "vector"))
    text += f"\n/// The messages as plain values.\nnamespace {idl.module} {{\n"
    for item in idl.items:
        text += "\n" + doc(item.comment)
        if isinstance(item, Const):
            text += f"inline constexpr {NUMBERS[item.type]} {item.name} = {item.value}{'u' * ('uns' in item.type)};\n"
        elif isinstance(item, Enum):
            text += f"enum {item.name} : std::uint32_t {{\n"
            text += "".join(f"  {n} = {v},{'  ///< ' + words if words else ''}\n" for n, v, words in item.values)
            text += "};\n"
        else:
            text += f"struct {item.name} {{\n" + "".join(map(field_text, item.fields))
            text += f"  friend bool operator==(const {item.name}&, const {item.name}&) = default;\n}};\n"
    return text + f"\n}}  // namespace {idl.module}\n"


def fields(idl):
    text = f"""#include <concepts>
#include <type_traits>

#include "idl/messages.hpp"

/// Fields in wire order: `fields(v, a, others...)` calls v("name", a.name, others.name...) for each; the others are any
/// structs with the same member names. `key_fields(v, a)` calls v(a.name) for those that are the key.
namespace {idl.module} {{

/// Calls X(M) for every message that a topic carries, and for every other struct.
#define PALPATE_MESSAGES(X) {' '.join(f'X({s.name})' for s in idl.messages())}
#define PALPATE_PARTS(X) {' '.join(f'X({s.name})' for s in idl.structs() if not s.topics)}
"""
    for s in idl.structs():
        visits = "".join(f'  visit("{f.name}", message.{f.name}, others.{f.name}...);\n' for f in s.fields)
        keyed = "".join(f"  visit(message.{f.name});\n" for f in s.fields if f.key)
        unused = "" if keyed else "[[maybe_unused]] "
        text += f"""
constexpr const char* name_of(const {s.name}*) {{
  return "{s.name}";
}}
template <class Visitor, class M, class... Others>
requires std::same_as<std::remove_const_t<M>, {s.name}>
constexpr void fields(Visitor&& visit, M& message, Others&... others) {{
{visits}}}
template <class Visitor>
constexpr void key_fields({unused}Visitor&& visit, {unused}const {s.name}& message) {{
{keyed}}}
"""
    return text + f"\n}}  // namespace {idl.module}\n"


def limits(idl):
    text = f"""#include <cstddef>

#include "idl/messages.hpp"

/// What a sample from outside must fulfil before a node sees it.
namespace {idl.module} {{

/// Most elements of each sequence of M.
template <class M>
struct Limits;
"""
    for s in idl.structs():
        bounds = [f"  static constexpr std::size_t {f.name} = {f.extent};\n" for f in s.fields if f.kind == "sequence"]
        if bounds:
            text += f"template <>\nstruct Limits<{s.name}> {{\n{''.join(bounds)}}};\n"
    text += "\n/// True if a node may use the message. Indices into the scene are checked by the node that uses them.\n"
    text += "".join(f"bool valid(const {s.name}& m);\n" for s in idl.structs())
    return text + f"\n}}  // namespace {idl.module}\n"


def limits_cpp(idl):
    text = f'#include "idl/limits.hpp"\n\n#include "idl/checks.hpp"\n\nnamespace {idl.module} {{\n'
    for s in idl.structs():
        condition = " &&\n         ".join(conditions(idl, s))
        text += (f"\nbool valid(const {s.name}& m) {{\n  return {condition};\n}}\n" if condition else
                 f"\nbool valid(const {s.name}&) {{\n  return true;\n}}\n")
    return text + f"\n}}  // namespace {idl.module}\n"


def run_of(struct, topic):
    """Whose run the messages of a topic carry, where that is the only one that writes it."""
    starts = {"haptic": "start of the haptic loop", "deform": "start of the deform node"}
    writer = topic.cells["writers"]
    own = writer in starts and any(f.name == "run" and f.meaning == starts[writer] for f in struct.fields)
    return f"roles::{writer}" if own else "0"


def topics(idl):
    bits = "".join(f"  {role} = {1 << i},\n" for i, role in enumerate(idl.roles))
    rows = ""
    for s in idl.messages():
        for t in s.topics:
            reliable, depth, local, recorders = qos(idl, t)
            writers, readers = (" | ".join(f"roles::{role}" for role in roles_in(idl, t, cell)) or "0"
                                for cell in ("writers", "readers"))
            rows += (f'/// {t.content}\ninline constexpr Topic<{s.name}> {t.name}{{\n    "palpate/{t.name}", '
                     f'"{s.name}", {{{str(reliable).lower()}, {depth}, {str(local).lower()}, {recorders}}}, '
                     f"{writers}, {readers}, {run_of(s, t)}}};\n")
    return f"""#include <tuple>

#include "idl/messages.hpp"
#include "idl/topic.hpp"

/// The table of topics: everything that crosses the bus, and between whom.
namespace {idl.module} {{

/// Bits of those who take part and announce themselves, and their names in the order of the bits.
namespace roles {{
enum Bit : std::uint32_t {{
{bits}}};
inline constexpr const char* names[] = {{{', '.join(f'"{role}"' for role in idl.roles)}}};
}}  // namespace roles

namespace topics {{

{rows}
inline constexpr auto all = std::tuple{{{', '.join(t.name for t in idl.topics())}}};

/// Calls f(topic) for every row.
template <class F>
constexpr void for_each(F&& f) {{
  std::apply([&](const auto&... topic) {{ (f(topic), ...); }}, all);
}}

}}  // namespace topics
}}  // namespace {idl.module}
"""


def dds_types(idl):
    text = f"""#include <cstddef>

#include "idl/messages.hpp"
#include "{idl.module}.h"

/// The structs that idlc makes, each beside its message.
namespace {idl.module}::dds {{

template <class M>
struct Generated;
"""
    for s in idl.messages():
        text += (f"template <>\nstruct Generated<{s.name}> {{\n  using Type = {idl.module}_{s.name};\n  static const "
                 f"dds_topic_descriptor_t& descriptor() {{ return {idl.module}_{s.name}_desc; }}\n}};\n")
    text += "\n// Sequences of these are lent as they are.\n"
    lent = {f.element for s in idl.structs() for f in s.fields if f.kind == "sequence"}
    for s in idl.structs():
        if s.name in lent:
            text += f"static_assert(sizeof({s.name}) == sizeof({idl.module}_{s.name}));\n"
            text += "".join(f"static_assert(offsetof({s.name}, {f.name}) == "
                            f"offsetof({idl.module}_{s.name}, {f.name}));\n" for f in s.fields)
    return text + f"\n}}  // namespace {idl.module}::dds\n"


def table(idl):
    heads = ["topic", "message", "key", "delivery", "kept per key", "late joiners", "rate", "writers", "readers",
             "content"]
    rows = [heads, ["---"] * len(heads)]
    for s in idl.messages():
        for t in s.topics:
            reliable, depth, local, recorders = qos(idl, t)
            kept = (str(depth) if depth else "all") + (f"; {recorders} for recorders" if recorders else "")
            late = "-" if not local else "get the newest" if depth else "get all"
            rows.append([f"`palpate/{t.name}`", s.name, ", ".join(f.name for f in s.fields if f.key) or "-",
                         "reliable" if reliable else "best effort", kept, late, t.cells["rate"],
                         t.cells["writers"].replace("none", "-"), t.cells["readers"].replace("none", "-"), t.content])
    return "".join(f"| {' | '.join(row)} |\n" for row in rows)


def main(source, *where):
    try:
        idl = Idl(Path(source).read_text())
    except Fault as fault:
        sys.exit(f"{source}:{fault.line}: {fault}")
    if len(where) == 2 and where[0] == "--page":
        page = Path(where[1])
        before, rest = page.read_text().split(MARKS[0])
        page.write_text(before + MARKS[0] + "\n" + table(idl) + "\n" + MARKS[1] + rest.split(MARKS[1])[1])
        return
    head = "// Written by idl/generate.py; do not edit.\n"
    headers = {"messages.hpp": messages, "fields.hpp": fields, "limits.hpp": limits, "topics.hpp": topics,
               "dds_types.hpp": dds_types}
    files = {name: head + "#pragma once\n" + write(idl) for name, write in headers.items()}
    files |= {"limits.cpp": head + limits_cpp(idl), "topics.md": table(idl)}
    folder = Path(where[0])
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in files.items():  # what stays as it was keeps its time, so that nothing is compiled anew
        if not (folder / name).exists() or (folder / name).read_text() != text:
            (folder / name).write_text(text)


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    main(*sys.argv[1:])
