# SPDX-License-Identifier: Apache-2.0
"""Tables of time and what they say beside the paper's: sizes, block sizes, distributions, R, other works."""
import math
from collections.abc import Sequence

from rows import (MODES, Machine, Row, by_points, contestants, device_or_whole, group, measured, per_device, per_point, pick,
                  rank, ratio, reference_rows, sizes_of, synthetic)
from tables import hash_check, is_cadt, named
from words import NONE, bullets, count, number, percent, spread, table, times

MEASURES = (("median_ms", "whole call"), ("device_ms", "on the device"))


def both(row: Row | None) -> str:
    """"12.3 (4.56)": whole call, on the device."""
    if row is None or row.number("median_ms") is None:
        return NONE
    on_device = row.number("device_ms")
    return number(row.number("median_ms")) + (f" ({number(on_device)})" if on_device is not None else "")


def sizes(machines: Sequence[Machine], paper: dict) -> list[str]:
    lines = []
    for machine in machines:
        rows = machine.rows("sizes")
        if rows:
            lines += [f"### {machine.name}: times", "", "Milliseconds of the whole call, in brackets on the device. The "
                      f"paper's columns: {paper['sizes']['where']}, on {paper['machine']['gpu']}.", "",
                      *size_table(rows, paper), f"### {machine.name}: speed-ups", "",
                      "Whole call against whole call; in brackets cadt's time on the device against the other's whole "
                      "call, which is nearer to the paper's times (events on the card).", "", *speedup_table(rows, paper),
                      *bullets(size_sentences(rows, paper))]
            lines += hash_check(rows, several=False)[1]
    return lines


def paper_sizes(paper: dict) -> dict[int, dict[str, float | None]]:
    return {r[0]: dict(zip(paper["sizes"]["columns"], r)) for r in paper["sizes"]["rows"]}


def size_table(rows: list[Row], paper: dict) -> list[str]:
    reference, everybody = paper_sizes(paper), contestants(rows)
    body = []
    for points in sorted({*sizes_of(rows), *reference}):
        theirs = reference.get(points, {})
        body.append([count(points), *(both(pick(of, points=points)) for of in everybody.values()),
                     *(number(theirs.get(c)) for c in ("sequential", "cgal", "cudt"))])
    return table(["points", *(who.name() for who in everybody), "paper: sequential", "paper: CGAL", "paper: cuDT"], body)


def over(rows: list[Row], who: list[Row], other: str, points: int, column: str) -> float | None:
    """How many times faster: the other's whole call over ours."""
    ours, theirs = pick(who, points=points), pick(rows, who=other, points=points)
    return None if ours is None or theirs is None else ratio(theirs.number("median_ms"), ours.number(column))


def speedup_table(rows: list[Row], paper: dict) -> list[str]:
    reference = paper_sizes(paper)
    ours = {who: of for who, of in contestants(rows).items() if is_cadt(who)}
    body = []
    for points in sorted({*sizes_of(rows), *reference}):
        theirs = reference.get(points, {})
        line = [count(points)]
        for of in ours.values():
            for other in ("cgal", "sequential"):
                whole, on_device = (over(rows, of, other, points, column) for column, _ in MEASURES)
                line.append(times(whole) + (f" ({times(on_device)})" if on_device is not None else ""))
        body.append([*line, times(ratio(theirs.get("cgal"), theirs.get("cudt"))),
                     times(ratio(theirs.get("sequential"), theirs.get("cudt")))])
    head = [f"{who.name()} over {other}" for who in ours for other in ("CGAL", "sequential")]
    return table(["points", *head, "paper: cuDT over CGAL", "paper: cuDT over sequential"], body)


def size_sentences(rows: list[Row], paper: dict) -> list[str]:
    lines, limits = [], {"cgal": paper["sizes"]["max_speedup_cgal"], "sequential": paper["sizes"]["max_speedup_sequential"]}
    for who, of in contestants(rows).items():
        for other, theirs in limits.items() if is_cadt(who) else ():
            best = []
            for column, what in MEASURES:
                known = [(over(rows, of, other, n, column), n) for n in sizes_of(of)]
                value, points = max((k for k in known if k[0] is not None), default=(None, 0))
                if value is not None:
                    best.append(f"{times(value)} {what} at {count(points)} points")
            if best:
                name = "CGAL" if other == "cgal" else other
                lines.append(f"{who.name()}: at most {', '.join(best)} over {name}; the paper has up to {times(theirs)}.")
        common = [n for n in sizes_of(of) if n in paper_sizes(paper)] if is_cadt(who) else []
        if common:
            mine, theirs = device_or_whole(pick(of, points=common[-1])), paper_sizes(paper)[common[-1]]["cudt"]
            lines.append(f"{who.name()}: {count(common[-1])} points, the most that both have, take {number(mine)} ms "
                         f"{measured(pick(of, points=common[-1]))}, and {number(theirs)} ms in the paper on its card (ratio {number(ratio(mine, theirs))}).")
    return lines


def blocks(machines: Sequence[Machine], paper: dict) -> list[str]:
    lines, sentences, body = [], [], []
    marks = {int(size): name for size, name in paper["blocks"]["marks"].items()}
    shown = per_device(machines, "blocks")
    every = sorted({b for _, _, rows in shown for b in sizes_of(rows, "block")})
    for machine, who, rows in shown:
        name = f"{machine.name}: {who.name()}" if len(machines) > 1 else who.name()
        for points in sizes_of(rows):
            of_size = [row for row in rows if row.whole("points") == points]
            body.append([name, count(points), *(both(pick(of_size, block=b)) for b in every)])
            sentences += block_sentence(name, of_size, points, paper)
        told = [(pick(rows, block=b) or Row("", {})).number("occupancy") for b in every]
        if any(value is not None for value in told):
            body.append([name, "occupancy", *(percent(value, 0) for value in told)])
    if body:
        lines = ["Milliseconds of the whole call, in brackets on the device.", ""]
        lines += table(["device", "points", *(f"{b} ({marks[b]})" if b in marks else str(b) for b in every)], body)
    return lines + bullets(sentences)


def block_sentence(name: str, rows: list[Row], points: int, paper: dict) -> list[str]:
    """The fastest block against the one that the paper chose."""
    known = [row for row in rows if device_or_whole(row) is not None and row.whole("block")]
    chosen = pick(known, block=paper["blocks"]["chosen"])
    if not known or chosen is None:
        return []
    best = min(known, key=device_or_whole)
    more = ratio(device_or_whole(chosen), device_or_whole(best)) - 1
    says = (f"{name}, {count(points)} points: {best.whole('block')} threads a block are fastest "
            f"({number(device_or_whole(best))} ms {measured(best)}); the paper's choice, {paper['blocks']['chosen']}, takes "
            f"{percent(more)} more")
    if points == paper["blocks"]["points"] and chosen.number("occupancy") is not None:
        says += (f", with a theoretical occupancy of {percent(chosen.number('occupancy'), 0)} (the paper measured "
                 f"{percent(paper['blocks']['achieved_occupancy'], 0)} achieved, {paper['blocks']['achieved_where']})")
    return [says + "."]


def distributions(machines: Sequence[Machine], paper: dict) -> list[str]:
    reference, other = paper["distributions"]["reference"], paper["distributions"]["other"]
    body, real, sentences = [], [], []
    for machine, who, rows in per_device(machines, "distributions"):
        name = f"{machine.name}: {who.name()}" if len(machines) > 1 else who.name()
        base, made = reference_rows(rows, reference), synthetic(rows, reference)
        for row in by_points(rows):
            is_real = row.text("distribution") not in made
            near = min(base, key=lambda n: abs(math.log(n / max(row.number("points"), 1))), default=None)
            line = [name, row.text("distribution"), count(row.number("points")),
                    spread(*(row.number(c) for c in ("min_ms", "median_ms", "max_ms"))), number(row.number("device_ms"))]
            line += [times(ratio(per_point(row, c), per_point(base[near], c))) if near else NONE for c, _ in MEASURES]
            (real if is_real else body).append([*line, count(near)] if is_real else line)
        for points, uniform in sorted(base.items()):
            row = pick(rows, distribution=other, points=points)
            more = ratio(device_or_whole(row), device_or_whole(uniform)) if row else None
            if more is not None:
                sentences.append(f"{name}, {count(points)} points: {other} take {times(more)} the time of {reference} ones, "
                                 f"{measured(row)}; paper: {paper['distributions']['where']}.")
    columns = ["device", "distribution", "points", "whole call, ms", "on the device, ms", f"a point, {reference} = 1",
               "the same on the device"]
    lines = table(columns, body, left=2)
    if real:
        lines += [f"Real sets; a point compared with the {reference} set that is nearest in size:", ""]
        lines += table([*columns, f"{reference} points"], real, left=2)
    return lines + bullets(sentences)


def thresholds(machines: Sequence[Machine], paper: dict) -> list[str]:
    lines, sentences, several = [], [], len(machines) > 1
    for machine in machines:
        cases = group(machine.rows("thresholds"), "who", "device", "distribution", "points")
        for (_, _, distribution, points), rows in cases.items():
            off = pick(rows, stabilize="off")
            name = f"{named(rows[0], several)}, {distribution}, {count(float(points or 0))} points"
            rows = sorted(rows, key=lambda r: (rank(r.text("stabilize"), MODES), r.number("threshold") or 0))
            lines += [f"### {name}", ""] + table(
                ["mode", "R", "on the device, ms", "against off", "whole call, ms", "flips", "stabilised", "illegal edges",
                 "differing triangles", "share"], [threshold_line(row, off) for row in rows])
            sentences += threshold_sentences(name, rows, off, paper["thresholds"])
    return bullets(sentences) + lines


def threshold_line(row: Row, off: Row | None) -> list[str]:
    against = ratio(row.number("device_ms"), off.number("device_ms")) if off else None
    return [row.text("stabilize"), row.text("threshold") or NONE, number(row.number("device_ms")),
            percent(None if against is None else against - 1, sign=True),
            spread(*(row.number(c) for c in ("min_ms", "median_ms", "max_ms"))),
            *(count(row.number(c)) for c in ("flips", "stabilized_edges", "illegal_edges", "differing_triangles")),
            percent(ratio(row.number("differing_triangles"), row.number("triangles")), 2)]


def threshold_sentences(name: str, rows: list[Row], off: Row | None, paper: dict) -> list[str]:
    lines = []
    for mode in MODES[1:]:
        row = pick(rows, stabilize=mode, threshold=paper["threshold"])
        share = ratio(device_or_whole(row), device_or_whole(off)) if row and off else None
        if share is not None:
            theirs = percent(-paper["time_reduction"], 0, sign=True)
            lines.append(f"{name}: {mode} with R = {paper['threshold']} changes the time {measured(row)} by "
                         f"{percent(share - 1, sign=True)}; "
                         f"the paper: {theirs} for complex distributions ({paper['where']}).")
    return lines


def works(machines: Sequence[Machine], paper: dict) -> list[str]:
    cited, several, body, sentences = paper["works"]["rows"], len(machines) > 1, [], []
    for work in cited:
        body.append([work["work"], work["what"], count(work["points"]), number(work["previous_ms"]),
                     number(work["cudt_ms"]), NONE, NONE, NONE, NONE, NONE])
        for machine in machines:
            for row in by_points(machine.rows("works")):
                if nearest(cited, row) is not work:
                    continue
                body.append(["", f"{named(row, several)}, {row.text('distribution')}", count(row.number("points")), "", "",
                             *(number(row.number(c)) for c, _ in MEASURES),
                             *(times(ratio(work["previous_ms"], row.number(c))) for c, _ in MEASURES),
                             times(ratio(work["cudt_ms"], row.number("device_ms")))])
        other = [r for r in paper["sizes"]["rows"] if abs(math.log(r[0] / work["points"])) < 0.1]
        if other:
            sentences.append(f"The paper has two times for about {count(work['points'])} points: {number(work['cudt_ms'])} ms "
                             f"here, and {number(other[0][3])} ms for {count(other[0][0])} points in its Table 3.")
    lines = table(["work", "what", "points", "previous work, ms", "cuDT, ms", "cadt, whole call, ms", "cadt, on the device, "
                   "ms", "whole call over previous", "on the device over previous", "on the device over cuDT"], body, left=2)
    return lines + bullets(sentences)


def nearest(cited: list[dict], row: Row) -> dict:
    """The work that a row belongs to: the bunny has some points fewer than the one of the paper."""
    return min(cited, key=lambda work: abs(math.log(work["points"] / max(row.number("points"), 1))))
