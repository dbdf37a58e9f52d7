# SPDX-License-Identifier: Apache-2.0
"""The blocks of a page: code and commands, with their captions and the tabs that they stand in.

usage: pages.py --programs FOLDER PAGE...    writes each C++ program of the pages as FOLDER/PAGE.CAPTION, and says which
"""

import dataclasses
import pathlib
import re
import sys


@dataclasses.dataclass
class Block:
    language: str  # "cpp", "python", "console", "text", ...
    caption: str  # name of the file, "" if it has none
    tab: str  # title of the tab, "" outside
    text: str
    line: int


FENCE = re.compile(r"^(`{3,}|:{3,})(\{?[\w-]*\}?) ?(.*)$")


def blocks(text: str) -> list[Block]:
    """In the order of the page. Directives that hold blocks (tabs) are entered; all others are none."""
    found: list[Block] = []
    tabs: list[tuple[str, str]] = []  # open directives: fence and title
    lines = text.split("\n")
    number = 0
    while number < len(lines):
        match = FENCE.match(lines[number])
        number += 1
        if not match:
            continue
        fence, name, argument = match.groups()
        if not name:
            if tabs and tabs[-1][0] == fence:
                tabs.pop()
                continue
            raise ValueError(f"line {number}: a fence without a language")
        if name in ("{tab-set}", "{tab-item}"):
            tabs.append((fence, argument))
            continue
        begin = number
        while lines[number] != fence:
            number += 1
        body = lines[begin:number]
        number += 1
        caption = ""
        language = name
        if name == "{code-block}":
            language = argument
            while body and body[0].startswith(":"):
                if body[0].startswith(":caption: "):
                    caption = body[0].removeprefix(":caption: ")
                body = body[1:]
            body = body[1:] if body and not body[0] else body
        elif name.startswith("{"):
            continue
        found.append(Block(language, caption, tabs[-1][1] if tabs else "", "\n".join(body) + "\n", begin))
    if tabs:
        raise ValueError(f"{tabs[-1][1]}: no end")
    return found


def of_page(path: pathlib.Path) -> list[Block]:
    return blocks(path.read_text(encoding="utf-8"))


def main() -> None:
    if len(sys.argv) < 4 or sys.argv[1] != "--programs":
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    for page in map(pathlib.Path, sys.argv[3:]):
        for block in of_page(page):
            if block.language == "cpp" and block.caption:
                path = folder / f"{page.stem}.{block.caption}"
                if not path.exists() or path.read_text(encoding="utf-8") != block.text:
                    path.write_text(block.text, encoding="utf-8")
                print(path)


if __name__ == "__main__":
    main()
