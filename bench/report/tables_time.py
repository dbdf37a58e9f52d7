# SPDX-License-Identifier: Apache-2.0
"""Tables of time and what they say beside the paper's: sizes, block sizes, distributions, R, other works."""
import math
from collections.abc import Sequence

from rows import (MODES, Machine, Row, by_points, contestants, device_or_whole, group, measured, per_device, per_point,
                  pick, rank, ratio, reference_rows, sizes_of, synthetic, to_number)
from tables import hash_check, is_cadt, named, other_counts
from words import NONE, bullets, count, listed, number, percent, spread, table, times

MEASURES = (("median_ms", "whole call"), ("device_ms", "on the device"))


def both(row: Row | None) -> str:
    """"12.3 (4.56)": whole call, on the device. "(4.56)" of a program that is measured on the device only."""
    if row is None:
        return NONE
    whole, on_device = row.number("median_ms"), row.number("device_ms")
    parts = [number(whole)] if whole is not None else []
    return " ".join(parts + ([f"({number(on_device)})"] if on_device is not None else [])) or NONE


def sizes(machines: Sequence[Machine], paper: dict) -> list[str]:
    lines = side_by_side(machines)
    for machine in machines:
        rows = machine.rows("sizes")
        if rows:
            lines += [f"### {machine.name}: times", "",
                      "Milliseconds of the whole call, in brackets on the device. The "
                      f"paper's columns: {paper['sizes']['where']}, on {paper['machine']['gpu']}.", "",
                      *size_table(rows, paper), f"### {machine.name}: speed-ups", "",
                      "Whole call against whole call; in brackets cadt's time on the device against the other's whole "
                      "call, which is nearer to the paper's times (events on the card).", "",
                      *speedup_table(rows, paper),
                      *bullets(size_sentences(rows, paper))]
            lines += hash_check(rows, several=False)[1] + other_counts(rows)
    return lines


def side_by_side(machines: Sequence[Machine]) -> list[str]:
    """cadt's devices of all machines in one table, where there are several."""
    ours = {who: of for m in machines for who, of in contestants(m.rows("sizes")).items() if is_cadt(who)}
    if len({who.machine for who in ours}) < 2:
        return []
    body = [[count(points), *(both(pick(of, points=points)) for of in ours.values())]
            for points in sizes_of(row for of in ours.values() for row in of)]
    return ["### Side by side", "", "Milliseconds of the whole call, in brackets on the device.", "",
            *table(["points", *(f"{who.machine}: {who.name()}" for who in ours)], body)]


def paper_sizes(paper: dict) -> dict[int, dict[str, float | None]]:
    return {r[0]: dict(zip(paper["sizes"]["columns"], r)) for r in paper["sizes"]["rows"]}


def size_table(rows: list[Row], paper: dict) -> list[str]:
    reference, everybody = paper_sizes(paper), contestants(rows)
    body = []
    for points in sorted({*sizes_of(rows), *reference}):
        theirs = reference.get(points, {})
        body.append([count(points), *(both(pick(of, points=points)) for of in everybody.values()),
                     *(number(theirs.get(c)) for c in ("sequential", "cgal", "cudt"))])
    return table(["points", *(who.name() for who in everybody), "paper: sequential", "paper: CGAL", "paper: cuDT"],
                 body)


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
    lines, limits = [], {"cgal": paper["sizes"]["max_speedup_cgal"],
                         "sequential": paper["sizes"]["max_speedup_sequential"]}
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
                lines.append(f"{who.name()}: at most {', '.join(best)} over {name}; the paper: up to {times(theirs)}.")
        common = [n for n in sizes_of(of) if n in paper_sizes(paper)] if is_cadt(who) else []
        if common:
            mine, theirs = device_or_whole(pick(of, points=common[-1])), paper_sizes(paper)[common[-1]]["cudt"]
            lines.append(f"{who.name()}: {count(common[-1])} points, the most that both have, take {number(mine)} ms "
                         f"{measured(pick(of, points=common[-1]))}, and {number(theirs)} ms in the "
                         f"paper on its card (ratio {number(ratio(mine, theirs))}).")
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
        sentences += block_sentence(name, rows, paper["blocks"])
        told = [(pick(rows, block=b) or Row("", {})).number("occupancy") for b in every]
        if any(value is not None for value in told):
            body.append([name, "occupancy", *(percent(value, 0) for value in told)])
    if body:
        lines = ["Milliseconds of the whole call, in brackets on the device.", ""]
        lines += table(["device", "points", *(f"{b} ({marks[b]})" if b in marks else str(b) for b in every)], body)
    return lines + bullets(sentences)


def block_sentence(name: str, rows: list[Row], paper: dict) -> list[str]:
    """The fastest block of each size against the one that the paper chose."""
    parts, told = [], ""
    for points in sizes_of(rows):
        known = [r for r in rows if r.whole("points") == points and device_or_whole(r) and r.whole("block")]
        chosen = pick(known, block=paper["chosen"])
        if chosen is None:
            continue
        best = min(known, key=device_or_whole)
        parts.append(f"{best.whole('block')} at {count(points)} points (the paper's {paper['chosen']}: "
                     f"{percent(ratio(device_or_whole(chosen), device_or_whole(best)) - 1, sign=True)})")
        if points == paper["points"] and chosen.number("occupancy") is not None:
            told = (f" Theoretical occupancy with {paper['chosen']} threads: {percent(chosen.number('occupancy'), 0)}; "
                    f"the paper measured {percent(paper['achieved_occupancy'], 0)} achieved "
                    f"({paper['achieved_where']}).")
    return [f"{name}, fastest block, {measured(rows[0])}: {listed(parts)}.{told}"] if parts else []


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
                    spread(*(row.number(c) for c in ("min_ms", "median_ms", "max_ms"))),
                    number(row.number("device_ms"))]
            line += [times(ratio(per_point(row, c), per_point(base[near], c))) if near else NONE for c, _ in MEASURES]
            (real if is_real else body).append([*line, count(near)] if is_real else line)
        pairs = {points: pick(rows, distribution=other, points=points) for points in sorted(base)}
        more = [f"{times(ratio(device_or_whole(row), device_or_whole(base[points])))} at {count(points)} points"
                for points, row in pairs.items() if row]
        if more:
            sentences.append(f"{name}, {measured(rows[0])}: {other} take {listed(more)} of the time of {reference} "
                             f"points; paper: {paper['distributions']['where']}.")
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
            name = f"{named(rows[0], several)}, {distribution}, {count(to_number(points))} points"
            rows = sorted(rows, key=lambda r: (rank(r.text("stabilize"), MODES), r.number("threshold") or 0))
            lines += [f"### {name}", ""] + table(
                ["mode", "R", "on the device, ms", "against off", "whole call, ms", "flips", "stabilised",
                 "illegal edges", "differing triangles", "share"], [threshold_line(row, off) for row in rows])
            if distribution == paper["thresholds"]["distribution"]:
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
            lines.append(f"{name}: mode {mode} with R = {paper['threshold']} changes the time {measured(row)} by "
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
                body.append(["", f"{named(row, several)}, {row.text('distribution')}", count(row.number("points")),
                             "", "", *(number(row.number(c)) for c, _ in MEASURES),
                             *(times(ratio(work["previous_ms"], row.number(c))) for c, _ in MEASURES),
                             times(ratio(work["cudt_ms"], row.number("device_ms")))])
        other = [r for r in paper["sizes"]["rows"] if abs(math.log(r[0] / work["points"])) < 0.1]
        if other:
            sentences.append(f"The paper has two times for about {count(work['points'])} points: "
                             f"{number(work['cudt_ms'])} ms here, and {number(other[0][3])} ms for "
                             f"{count(other[0][0])} points in its Table 3.")
    lines = table(["work", "what", "points", "previous work, ms", "cuDT, ms", "here, whole call, ms",
                   "here, on the device, ms", "whole call over previous", "on the device over previous",
                   "on the device over cuDT"], body, left=2)
    return lines + bullets(sentences) + other_counts([row for machine in machines for row in machine.rows("works")])


def nearest(cited: list[dict], row: Row) -> dict:
    """The work that a row belongs to: the bunny has some points fewer than the one of the paper."""
    return min(cited, key=lambda work: abs(math.log(work["points"] / max(row.number("points"), 1))))
