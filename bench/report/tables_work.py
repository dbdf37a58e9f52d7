# SPDX-License-Identifier: Apache-2.0
"""Tables of what is done, and what they say beside the paper's: shares of the time, flips, meshes, statistics,
devices."""
from collections.abc import Sequence

from meshes import Bunny, Snapshots, chosen_steps
from rows import (DETAILS, FLIP_BINS, MODES, Machine, Row, by_points, each, group, like, per_device, per_point, pick,
                  rank, ratio, sizes_of, to_number)
from tables import hash_check, named
from words import NONE, bullets, count, number, percent, spread, table

COUNTED = ("lock_attempts", "lock_failures", "invalid_restarts", "insert_retries", "deferred_points", "deferred_edges", "flips",
           "walk_steps")


def breakdown(machines: Sequence[Machine], paper: dict) -> list[str]:
    lines, sentences, several = [], [], len(machines) > 1
    theirs = paper["breakdown"]
    for column, title in (("thread_time", "Shares of the threads' time"), ("phases", "Phases, milliseconds")):
        rows = [row for _, _, of in per_device(machines, "breakdown") for row in of if row.pairs(column)]
        names = list(dict.fromkeys(name for row in rows for name in row.pairs(column)))
        show = percent if column == "thread_time" else number
        body = [[named(row, several), row.text("distribution"), count(row.number("points")),
                 *(show(row.pairs(column).get(name)) for name in names)] for row in rows]
        if body:
            lines += [f"### {title}", "", *table(["device", "distribution", "points", *names], body, left=2)]
        for row in rows if column == "thread_time" else []:
            shares = row.pairs(column)
            sentences += [f"{named(row, several)}, {row.text('distribution')}: {percent(shares[name])} of the threads' "
                          f"time goes into {name}; the paper: {percent(share, 0)} ({theirs['where']})."
                          for name, share in theirs["shares"].items()
                          if name in shares and row.text("distribution") == theirs["distribution"]]
    return bullets(sentences) + lines


def snapshots(machine: Machine, found: Snapshots, paper: dict) -> list[str]:
    theirs, steps, body = paper["snapshots"], chosen_steps(list(found.steps)), []
    for step, triangles in found.steps.items():
        row = pick(machine.rows("snapshots"), block=step)
        panel = "abcd"[steps.index(step)] if step in steps else ""
        body.append([step, panel, count(row.number("points")) if row else NONE, count(len(triangles))])
    lines = table(["step", "panel", "points in the mesh", "live triangles"], body)
    if found.steps:
        points = len(found.points)
        most = max(map(len, found.steps.values()))
        shown = dict(zip("abcd", (len(found.steps[step]) for step in steps)))
        same = theirs["panel"] in shown and f"({theirs['panel']}) has {count(shown[theirs['panel']])} live triangles, "
        lines += bullets([f"{machine.name}: {same or ''}no step more than {count(most)}; a triangulation of "
                          f"{count(points)} points has at most 2·{points} − 5 = {count(2 * points - 5)}. The paper "
                          f"shows {count(theirs['live_triangles'])} of {count(theirs['points'])} points in its "
                          f"({theirs['panel']}), as it counts those that are gone by then ({theirs['where']})."])
    return lines


def over_threshold(flips: list[int] | None, threshold: int | None) -> int | None:
    """Edges flipped more than R times. The last bin holds 15 and more, so larger R cannot be told."""
    if flips is None or threshold is None or threshold >= FLIP_BINS - 1:
        return None
    return sum(flips[threshold + 1:])


def reduction(without: int | None, stabilized: int | None) -> float | None:
    """Eq. 9 of the paper, as a share: (E - E_proposed) / E."""
    return None if without is None or stabilized is None or not without else (without - stabilized) / without


def longest(flips: list[int]) -> str:
    last = max(k for k in range(FLIP_BINS) if flips[k])
    return f"{last}+" if last == FLIP_BINS - 1 else str(last)


def flips(machines: Sequence[Machine], paper: dict) -> list[str]:
    body, sentences, several = [], [], len(machines) > 1
    rows = [row for row in each(machines, lambda m: m.rows("flips")) if row.flips()]
    for (machine, who, device, distribution, points), of in grouped_flips(rows).items():
        theirs = next((p for p in paper["flips"] if p["distribution"] == distribution
                       and like(of[0].number("points"), p["points"])), None)
        off = pick(of, stabilize="off")
        common = next((r.whole("threshold") for r in of if r.text("stabilize") != "off"
                       and r.whole("threshold") is not None), theirs["threshold"] if theirs else None)
        for row in sorted(of, key=lambda r: rank(r.text("stabilize"), MODES)):
            is_off = row.text("stabilize") == "off"
            threshold = common if is_off or row.whole("threshold") is None else row.whole("threshold")
            body.append(flip_line(named(row, several), row, None if is_off else off, threshold))
            sentences += flip_sentences(named(row, several), row, off, threshold, theirs)
    head = ["device", "distribution", "mode", "points", "R", "edges", "0 flips", "above R", "share", "most flips",
            "reduction (Eq. 9)", "stabilised", "illegal edges", "share", "differing triangles", "share"]
    lines = table(head, body + [paper_flip_line(p, mode) for p in paper["flips"] for mode in ("off", "paper")] if body
                  else [],
                  left=3)
    return lines + bullets(sentences)


def grouped_flips(rows: Sequence[Row]) -> dict[tuple[str, ...], list[Row]]:
    return {(machine, *key): of for machine in dict.fromkeys(row.machine for row in rows)
            for key, of in group([r for r in rows if r.machine == machine], "who", "device", "distribution",
                                 "points").items()}


def flip_line(name: str, row: Row, off: Row | None, threshold: int | None) -> list[str]:
    counts = row.flips()
    edges, above = sum(counts), over_threshold(counts, threshold)
    without = over_threshold(off.flips(), threshold) if off else None
    illegal, differing = row.number("illegal_edges"), row.number("differing_triangles")
    return [name, row.text("distribution"), row.text("stabilize"), count(row.number("points")), count(threshold),
            count(edges), percent(counts[0] / edges), count(above), percent(ratio(above, edges), 2), longest(counts),
            percent(reduction(without, above)) if off else NONE, count(row.number("stabilized_edges")), count(illegal),
            percent(ratio(illegal, edges), 2), count(differing), percent(ratio(differing, row.number("triangles")), 2)]


def paper_flip_line(theirs: dict, mode: str) -> list[str]:
    off = mode == "off"
    return [f"paper, {theirs['figure']}", theirs["distribution"], mode, count(theirs["points"]),
            count(theirs["threshold"]),
            NONE, percent(theirs["unflipped_share"], 0) if off else NONE,
            count(theirs["over_off" if off else "over_stabilized"]), percent(theirs["over_share"]) if off else NONE,
            count(theirs["longest_off" if off else "longest_stabilized"]),
            NONE if off else percent(theirs["reduction"], 0), NONE, NONE, NONE, NONE, NONE]


def flip_sentences(name: str, row: Row, off: Row | None, threshold: int | None, theirs: dict | None) -> list[str]:
    if theirs is None:
        return []
    counts, where = row.flips(), f"{name}, {row.text('distribution')}"
    if row.text("stabilize") == "off":
        says = f"{percent(counts[0] / sum(counts))} of the edges are never flipped (paper: " \
               f"{percent(theirs['unflipped_share'], 0)})"
        above = ratio(over_threshold(counts, threshold), sum(counts))
        if above is not None and theirs["over_share"] is not None:
            says += f", {percent(above, 2)} more than {threshold} times (paper: {percent(theirs['over_share'])})"
        return [f"{where}: {says}."]
    less = reduction(over_threshold(off.flips(), threshold) if off else None, over_threshold(counts, threshold))
    if less is None:
        return []
    word = "fewer" if less >= 0 else "more"
    return [f"{where}: mode {row.text('stabilize')} has {percent(abs(less))} {word} edges flipped more than "
            f"{threshold} times (Eq. 9); the paper: {percent(theirs['reduction'], 0)} ({theirs['where']})."]


def bunny(machines: Sequence[Machine], sets: dict[str, list[Bunny]], paper: dict) -> list[str]:
    body, sentences, several, theirs = [], [], len(machines) > 1, paper["bunny"]
    for machine in machines:
        drawn = {one.name: one for one in sets.get(machine.name, [])}
        for row in by_points(machine.rows("bunny")):
            body.append([named(row, several), row.text("distribution"), row.text("stabilize") or NONE,
                         count(row.number("points")), number(row.number("median_ms")), count(row.number("triangles")),
                         *(count(row.number(c)) for c in ("illegal_edges", "differing_triangles")),
                         percent(ratio(row.number("differing_triangles"), row.number("triangles")), 2)])
        for one in drawn.values():
            differing, total = len(one.differing()), len(one.paper.triangles)
            sentences.append(f"{machine.name}, {one.name}: {differing:,} of {total:,} triangles differ in the picture "
                             f"({percent(differing / total, 2)}); the paper: {theirs['differing']} of "
                             f"{theirs['triangles']} ({percent(theirs['differing'] / theirs['triangles'], 2)}) for "
                             f"{theirs['points'][0]} points, and less than "
                             f"{percent(theirs['differing_share_bound'])} in all experiments ({theirs['where']}).")
    head = ["device", "set", "mode", "points", "whole call, ms", "triangles", "illegal edges", "differing triangles",
            "share"]
    return table(head, body, left=3) + bullets(sentences)


def statistics(machines: Sequence[Machine], paper: dict) -> list[str]:
    costs, counted, several = [], [], len(machines) > 1
    for machine, who, rows in per_device(machines, "statistics", modes=False):
        name = f"{machine.name}: {who.name()}" if several else who.name()
        size = max(sizes_of(row for row in rows if row.text("detail") == "none"), default=None)
        base = pick(rows, detail="none", points=size) if size else None
        of_size = sorted((r for r in rows if r.whole("points") == size), key=lambda r: rank(r.text("detail"), DETAILS))
        costs += [cost_line(name, row, base) for row in of_size if base]
        for row in by_points(r for r in rows if r.text("detail") in ("counters", "")):
            counted.append([name, count(row.number("points")), *(number(per_point(row, c)) for c in COUNTED),
                            percent(ratio(row.number("lock_failures"), row.number("lock_attempts")), 2)])
    lines = []
    if costs:
        lines += ["### What it costs", "", *table(["device", "statistics", "points", "whole call, ms", "more than none",
                                                   "fastest to slowest", "on the device, ms"], costs, left=2)]
    if counted:
        lines += ["### Counted, a point", "", *table(["device", "points", *(c.replace("_", " ") for c in COUNTED),
                                                      "failed of all lock attempts"], counted)]
    return lines


def cost_line(name: str, row: Row, base: Row) -> list[str]:
    more = [ratio(row.number(c), base.number("median_ms")) for c in ("median_ms", "min_ms", "max_ms")]
    middle, low, high = (percent(None if value is None else value - 1, sign=True) for value in more)
    return [name, row.text("detail"), count(row.number("points")), number(row.number("median_ms")), middle,
            f"{low} to {high}", number(row.number("device_ms"))]


def devices(machines: Sequence[Machine], paper: dict) -> list[str]:
    several, rows = len(machines) > 1, each(machines, lambda m: m.rows("devices"))
    if not rows:
        return []
    verdicts, lines = hash_check(rows, several)
    for (distribution, points), of in group(rows, "distribution", "points").items():
        body = [[named(row, several), spread(*(row.number(c) for c in ("min_ms", "median_ms", "max_ms"))),
                 number(row.number("device_ms")), row.text("hash")[:12] or NONE,
                 percent(ratio(row.number("lock_failures"), row.number("lock_attempts")), 2),
                 *(number(per_point(row, c)) for c in ("insert_retries", "deferred_points", "deferred_edges", "flips")),
                 row.text("certified") or NONE] for row in of]
        lines += [f"### {distribution}, {count(to_number(points))} points: meshes "
                  f"{verdicts.get((distribution, points), 'without hash')}", "",
                  *table(["device", "whole call, ms", "on the device, ms", "hash", "failed of all lock attempts",
                          "retries a point",
                          "deferred points a point", "deferred edges a point", "flips a point", "certified"], body)]
    return lines
