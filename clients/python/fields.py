#!/usr/bin/env python3
"""Writes vines/_fields.py, the types of the requests' fields, from what `vines openapi` says.

fields.py [--check] [PROGRAM]: with --check it changes nothing, and ends with 1 if the file differs.
"""

from __future__ import annotations

import json
import keyword
import pathlib
import subprocess
import sys
import textwrap
from collections.abc import Iterator
from typing import Any

FILE = pathlib.Path(__file__).parent / "vines" / "_fields.py"

HEAD = '''"""The fields of the requests. Made by fields.py from the OpenAPI document."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal, TypedDict
'''

# Class, schema, what it says of itself.
KEYWORDS = [
    ("SimulateFields", "SimulateRequest", "Fields of a simulation."),
    ("SweepFields", "SweepRequest", "Fields of a sweep."),
    ("IdentifyFields", "IdentifyRequest", "Fields of an identification."),
]
OBJECTS = ["SweepBase", "Axis", "Start"]

# The client's own affair: the form of an answer, and what identify takes by other names.
NOT_FIELDS = {"format", "record", "impacts"}


def main() -> None:
    arguments = sys.argv[1:]
    check = arguments[:1] == ["--check"]
    program = (arguments[check:] or ["vines"])[0]
    said = subprocess.run([program, "openapi"], check=True, capture_output=True).stdout
    text = module(json.loads(said)["components"]["schemas"])
    if not check:
        FILE.write_text(text)
    elif FILE.read_text() != text:
        sys.exit(f"{FILE.name} is not what {program} says: run clients/python/fields.py {program}")


def module(schemas: dict[str, Any]) -> str:
    perturbation = schemas["SimulateRequest"]["properties"]["perturbation"]
    objects = [("Perturbation", perturbation), *((name, schemas[name]) for name in OBJECTS)]
    parts = [HEAD, number_lists(schemas)]
    parts += [functional(name, schema) for name, schema in objects]
    parts += [declared(name, schemas[schema], what) for name, schema, what in KEYWORDS]
    return "\n\n".join(part.strip("\n") for part in parts) + "\n"


def functional(name: str, schema: dict[str, Any]) -> str:
    """An object given as a dict: its keys may be words of Python's own, such as "from"."""
    items = "\n".join(f'        "{key}": {typed(key, value)},' for key, value in properties(schema))
    lines = "\n".join(told(key, value) for key, value in properties(schema))
    made = f'{name} = TypedDict(\n    "{name}",\n    {{\n{items}\n    }},\n    total=False,\n)'
    return f'{made}\n{name}.__doc__ = """An object of these keys.\n\n{lines}\n"""'


def declared(name: str, schema: dict[str, Any], what: str) -> str:
    """Keyword arguments."""
    fields = list(properties(schema))
    docs = textwrap.indent("\n".join(told(own_name(k), v) for k, v in fields), "    ")
    items = "\n".join(f"    {own_name(key)}: {typed(key, value)}" for key, value in fields)
    return f'class {name}(TypedDict, total=False):\n    """{what}\n\n{docs}\n    """\n\n{items}'


def properties(schema: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    return ((k, v) for k, v in schema["properties"].items() if k not in NOT_FIELDS)


def own_name(key: str) -> str:
    return f"{key}_" if keyword.iskeyword(key) else key


def typed(key: str, schema: dict[str, Any]) -> str:
    if key == "perturbation":
        return "Perturbation"
    if "$ref" in schema:
        return str(schema["$ref"]).rsplit("/", 1)[1]
    if "anyOf" in schema:
        return " | ".join(typed(key, one) for one in schema["anyOf"])
    if "enum" in schema:
        return f"Literal[{', '.join(json.dumps(word) for word in schema['enum'])}]"
    if schema["type"] == "array":
        return f"Iterable[{typed(key, schema['items'])}]"
    return {"number": "float", "integer": "int", "string": "str"}[schema["type"]]


def told(key: str, schema: dict[str, Any]) -> str:
    """A field's lines: what it is with its unit, its range and default."""
    words = str(schema.get("description", "")).replace("\\", "\\\\")
    if "minimum" in schema and "maximum" in schema:
        words += f"; {schema['minimum']:g} to {schema['maximum']:g}"
    if "default" in schema:
        words += f"; default: {json.dumps(schema['default'])}"
    return textwrap.fill(f"{key}: {words}", 92, subsequent_indent="    ", break_on_hyphens=False)


def number_lists(schemas: dict[str, Any]) -> str:
    """The keys of answers that have lists of numbers, so that an empty one is known for one."""
    numbers: set[str] = set()
    others: set[str] = set()
    for name, schema in schemas.items():
        if not name.endswith("Request"):
            for key, is_number in lists(schema):
                (numbers if is_number else others).add(key)
    if both := numbers & others:
        sys.exit(f"lists of numbers in one place and of others in another: {sorted(both)}")
    names = textwrap.fill(
        ", ".join(f'"{name}"' for name in sorted(numbers)),
        92,
        initial_indent="    ",
        subsequent_indent="    ",
        break_on_hyphens=False,
    )
    return f"NUMBER_LISTS = frozenset({{\n{names},\n}})"


def lists(schema: dict[str, Any]) -> Iterator[tuple[str, bool]]:
    """Each key of an array in a schema, and whether numbers are in it."""
    for key, value in schema.get("properties", {}).items():
        if "array" in types(value):
            yield key, holds_numbers(value)
        yield from lists(value)
    inner = [schema["items"]] if isinstance(schema.get("items"), dict) else []
    for one in [*inner, *schema.get("anyOf", []), *schema.get("oneOf", [])]:
        yield from lists(one)


def holds_numbers(schema: dict[str, Any]) -> bool:
    if "array" in types(schema):
        return holds_numbers(schema["items"])
    return bool(types(schema)) and types(schema) <= {"number", "integer", "null"}


def types(schema: dict[str, Any]) -> set[str]:
    own = schema.get("type", [])
    return {own} if isinstance(own, str) else set(own)


if __name__ == "__main__":
    main()
