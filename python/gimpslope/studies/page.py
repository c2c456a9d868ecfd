"""A page of headings, paragraphs, tables and pictures, as Markdown and as HTML."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

_FRAME = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<title>{title}</title>
<style>
body {{ font: 16px/1.5 sans-serif; max-width: 60em; margin: 2em auto; padding: 0 1em; }}
table {{ border-collapse: collapse; font-size: 85%; margin: 1em 0; }}
th, td {{ border: 1px solid #ccc; padding: 0.2em 0.6em; text-align: left; }}
img {{ max-width: 100%; }}
</style>
</head>
<body>
{body}
</body>
</html>
"""


@dataclass(frozen=True)
class Heading:
    """A heading of level 1 or 2, with a name to link to."""

    text: str
    level: int = 2
    name: str = ""


@dataclass(frozen=True)
class Paragraph:
    """Text, with code between backticks; what it begins with may stand out."""

    text: str
    begins: str = ""


@dataclass(frozen=True)
class Grid:
    """A table of text."""

    columns: Sequence[str]
    rows: Sequence[Sequence[str]]


@dataclass(frozen=True)
class Picture:
    """A picture in a file beside the page."""

    file: str
    title: str


Block = Heading | Paragraph | Grid | Picture


def markdown(blocks: Sequence[Block]) -> str:
    """The page as Markdown."""
    return "\n\n".join(_markdown(block) for block in blocks) + "\n"


def markdown_row(cells: Sequence[str]) -> str:
    """A row of a table as Markdown."""
    return "| " + " | ".join(cell.replace("|", r"\|") for cell in cells) + " |"


def html(title: str, blocks: Sequence[Block]) -> str:
    """The page as one HTML file."""
    body = "\n".join(_html(block) for block in blocks)
    return _FRAME.format(title=escape(title), body=body)


def _markdown(block: Block) -> str:
    match block:
        case Heading():
            return f"{'#' * block.level} {block.text}"
        case Paragraph():
            return f"*{block.begins}:* {block.text}" if block.begins else block.text
        case Grid():
            rows = [block.columns, ["---"] * len(block.columns), *block.rows]
            return "\n".join(markdown_row(row) for row in rows)
        case Picture():
            return f"![{block.title}]({block.file})"


def _html(block: Block) -> str:
    match block:
        case Heading():
            named = f' id="{block.name}"' if block.name else ""
            return f"<h{block.level}{named}>{_text(block.text)}</h{block.level}>"
        case Paragraph():
            begins = f"<em>{_text(block.begins)}:</em> " if block.begins else ""
            return f"<p>{begins}{_text(block.text)}</p>"
        case Grid():
            head = "".join(f"<th>{_text(cell)}</th>" for cell in block.columns)
            rows = ("".join(f"<td>{_text(cell)}</td>" for cell in row) for row in block.rows)
            body = "\n".join(f"<tr>{row}</tr>" for row in rows)
            return f"<table>\n<tr>{head}</tr>\n{body}\n</table>"
        case Picture():
            return f'<p><img src="{escape(block.file)}" alt="{escape(block.title)}"></p>'


def _text(text: str) -> str:
    return re.sub("`([^`]*)`", r"<code>\1</code>", escape(text, quote=False))
