"""Makes docs/guide/python-reference.md of the docstrings of the installed package: `python python/tests/reference.py > docs/guide/python-reference.md`."""

import inspect
import re
import textwrap
from typing import Iterator

import mesoscope

#: Of a line, as in the other documents.
WIDTH = 118

HEAD = """# Python: all functions and classes

This page is made from the docstrings by `python/tests/reference.py`, and a test compares it with them. The introduction,
with recipes, is [Python](python.md).
"""


def words(documented: object) -> str:
    """The docstring without its examples, in lines of the guide."""
    text = inspect.getdoc(documented) or ""
    text = re.sub(r":(?:meth|func|attr|class):`([^`]*)`", r"`\1`", text.split(">>>")[0]).replace("``", "`")
    paragraphs = [" ".join(part.split()) for part in text.strip().split("\n\n")]
    return "\n\n".join(textwrap.fill(part, WIDTH, break_long_words=False, break_on_hyphens=False) for part in paragraphs)


def signature(name: str, called: object) -> str:
    """The call with its arguments, without types, which stubs have."""
    parameters = []
    starred = False
    for parameter in inspect.signature(called).parameters.values():
        if parameter.name in ("self", "cls") or parameter.name.startswith("_"):
            continue
        if parameter.kind is parameter.KEYWORD_ONLY and not starred:
            parameters.append("*")
            starred = True
        bare = parameter.replace(annotation=inspect.Parameter.empty)
        starred = starred or parameter.kind is parameter.VAR_POSITIONAL
        # Values of dataclasses that are made anew have no text of their own.
        parameters.append(str(bare).replace("<factory>", "…"))
    return f"{name}({', '.join(parameters)})"


def headed(name: str, shown: str) -> str:
    """The heading of a call, with its arguments below where they need more than a line."""
    if len(shown) <= 100:
        return f"## `{shown}`\n"
    lines = textwrap.fill(shown, WIDTH, subsequent_indent="    ", break_long_words=False, break_on_hyphens=False)
    return f"## {name}\n\n```text\n{lines}\n```\n"


def members(held: type) -> Iterator[str]:
    """Lines of a list: methods with their arguments, properties, fields."""
    inherited = set(dir(tuple)) | set(dir(Exception))
    for name in dir(held):
        if name.startswith("_") or name in inherited:
            continue
        member = inspect.getattr_static(held, name)
        if isinstance(member, property):
            yield entry(name, member)
        elif isinstance(member, (staticmethod, classmethod)):
            yield entry(signature(name, member.__func__), member.__func__)
        elif inspect.isfunction(member):
            yield entry(signature(name, member), member)


def entry(shown: str, documented: object) -> str:
    text = " ".join(words(documented).split())
    return textwrap.fill(
        f"- `{shown}`" + (f": {text}" if text else ""), WIDTH, subsequent_indent="  ", break_long_words=False, break_on_hyphens=False
    )


def reference() -> str:
    public = [getattr(mesoscope, name) for name in sorted(mesoscope.__all__, key=str.lower)]
    errors = [found for found in public if inspect.isclass(found) and issubclass(found, Exception)]
    parts = [HEAD]
    for found in sorted((found for found in public if found not in errors), key=inspect.isclass):
        listed = "\n".join(members(found)) if inspect.isclass(found) else ""
        name = found.__name__
        parts.append(f"{headed(name, signature(name, found))}\n{words(found)}\n" + (f"\n{listed}\n" if listed else ""))
    listed = "\n".join(entry(error.__name__, error) for error in errors)
    parts.append(f"## Errors\n\n{listed}\n")
    return "\n".join(parts)


if __name__ == "__main__":
    print(reference(), end="")
