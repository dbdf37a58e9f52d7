# SPDX-License-Identifier: Apache-2.0
"""Numbers and tables as Markdown shows them."""
from collections.abc import Iterable, Sequence

NONE = "–"


def significant(value: float, digits: int = 3) -> str:
    """Three digits that count, thousands separated: 0.260, 12.3, 4,570."""
    if value == 0:
        return "0"
    exponent = int(f"{value:.{digits - 1}e}".partition("e")[2])  # after rounding: 9.999 is 10.0
    return f"{value:,.{max(digits - 1 - exponent, 0)}f}" if exponent >= -4 else f"{value:.{digits - 1}e}"


def number(value: float | None) -> str:
    return NONE if value is None else significant(value)


def count(value: float | None) -> str:
    return NONE if value is None else f"{round(value):,}"


def percent(share: float | None, digits: int = 1, sign: bool = False) -> str:
    """A share as per cent; small ones keep two digits that count, so that few among many do not become none."""
    if share is None:
        return NONE
    value = 100 * share
    if value == 0:
        return "0 %"
    if 0 < abs(value) < 10 ** -digits:
        return f"{value:{'+' if sign else ''}.2g} %"
    return f"{value:{'+' if sign else ''}.{digits}f} %"


def times(value: float | None) -> str:
    if value is None:
        return NONE
    return f"×{value}" if isinstance(value, int) else f"×{significant(value)}"


def spread(low: float | None, middle: float | None, high: float | None) -> str:
    """"12.3 (12.1 to 13.0)"."""
    if middle is None:
        return NONE
    return number(middle) if low is None or high is None else f"{number(middle)} ({number(low)} to {number(high)})"


def short(value: float | None) -> str:
    """A number of points where there is little room: 8192, 131k, 1M, 33.6M. Round numbers stay as they are."""
    if value is None:
        return NONE
    for size, letter in ((1e6, "M"), (1e3, "k")):
        if value >= size and value >= 1e4:
            return f"{value / size:.3g}{letter}"
    return f"{value:.0f}"


def listed(parts: Sequence[str]) -> str:
    """"a, b and c"."""
    return " and ".join(filter(None, [", ".join(parts[:-1]), parts[-1]])) if parts else "none"


def cell(text: object) -> str:
    return str(text).replace("|", "\\|").replace("\n", " ")


def table(head: Sequence[str], rows: Iterable[Sequence[object]], left: int = 1) -> list[str]:
    """Lines of a Markdown table; the first `left` columns are text, the others numbers. Nothing without rows."""
    body = [f"| {' | '.join(cell(c) for c in row)} |" for row in rows]
    if not body:
        return []
    rule = [":---" if i < left else "---:" for i in range(len(head))]
    return [f"| {' | '.join(map(cell, head))} |", f"| {' | '.join(rule)} |", *body, ""]


def bullets(lines: Iterable[str]) -> list[str]:
    found = [f"- {line}" for line in lines]
    return [*found, ""] if found else []
