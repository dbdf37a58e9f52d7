# SPDX-License-Identifier: Apache-2.0
"""What the head and all sections have in common: machines, devices, peers, what was left out, equal meshes."""
from collections.abc import Sequence

from rows import CADT, Contestant, Machine, Row, group, hash_groups, to_number
from words import NONE, bullets, count, listed, table


def who_of(row: Row) -> Contestant:
    return Contestant(row.machine, row.text("who"), row.text("device"))


def named(row: Row, several: bool) -> str:
    """The device of a row, with its machine where there are several."""
    return f"{row.machine}: {who_of(row).name()}" if several else who_of(row).name()


def head(machines: Sequence[Machine]) -> list[str]:
    lines = ["## Machines", ""]
    lines += table(["machine", "processor", "cores", "memory, GiB", "system", "compiler", "date", "cadt", "commit"],
                   [[m.name, m.info.get("cpu", NONE), m.info.get("cores", NONE), gib(m.info.get("memory_bytes")),
                     m.info.get("os", NONE), m.info.get("compiler", NONE), m.info.get("date", NONE),
                     m.info.get("cadt", NONE), m.info.get("commit") or NONE] for m in machines], left=9)
    lines += bullets(f"**{m.name}: {problem}**" for m in machines for problem in m.problems)
    commits = {str(m.info.get("commit", "")) for m in machines}
    if len(commits) > 1:
        lines += ["**The machines ran different commits: what differs between them may be due to that.**", ""]
    return lines + ["## Devices", ""] + devices(machines) + ["## Other programs", ""] + peers(machines)


def gib(size: object) -> str:
    return f"{size / 2**30:.1f}" if isinstance(size, (int, float)) and size else NONE


def devices(machines: Sequence[Machine]) -> list[str]:
    lines = table(["machine", "back end", "device", "platform", "driver", "GPU", "compute units", "memory, GiB"],
                  [[m.name, d.get("backend", NONE), d.get("name", NONE), d.get("platform", NONE), d.get("driver", NONE),
                    "yes" if d.get("gpu") else "no", d.get("compute_units", NONE), gib(d.get("memory_bytes"))]
                   for m in machines for d in m.devices()], left=6) or ["No usable device is listed.", ""]
    return lines + bullets(f"{m.name}: {d.get('backend', '?')} {d.get('name', '')}".rstrip()
                           + f" was not used: {d.get('reason') or 'no reason given'}"
                           for m in machines for d in m.devices(usable=False))


def peers(machines: Sequence[Machine]) -> list[str]:
    rows = [[m.name, p.get("name", NONE), p.get("version") or NONE,
             "measured" if p.get("usable") else f"missing: {p.get('reason') or 'no reason given'}"]
            for m in machines for p in m.listed("peers")]
    return table(["machine", "program", "version", "state"], rows, left=4) or ["None is listed.", ""]


def method(machines: Sequence[Machine], experiments: Sequence[str]) -> list[str]:
    """How it was measured, with the numbers of warm-ups and runs that the rows have."""
    runs: dict[tuple[str, str], list[str]] = {}
    for m in machines:
        for experiment in experiments:
            for warmups, number in group(m.rows(experiment), "warmups", "runs"):
                if number:
                    runs.setdefault((warmups or "0", number), []).append(experiment)
    plural = lambda number, word: f"{number} {word}{'s' * (number != '1')}"  # noqa: E731
    lines = ["## How it was measured", "",
             "Times are medians; a second pair of numbers, or a bar, is the fastest and the slowest run. "
             "*Whole call* is from points in host memory to triangles in host memory. *On the device* is from points "
             "on the device to the mesh on the device: the sum of the phases but upload and copy. The two are never "
             "mixed: solid lines and bars are whole calls, dashed lines and diamonds are on the device.", ""]
    lines += bullets(f"{plural(warmups, 'warm-up')}, then {plural(number, 'run')}: {listed(list(dict.fromkeys(found)))}"
                     for (warmups, number), found in sorted(runs.items(), key=lambda item: -len(item[1])))
    return lines


def left_out(machines: Sequence[Machine], experiment: str) -> list[str]:
    """Rows without numbers and why; those of one device and reason together."""
    lines = []
    for m in machines:
        columns = ("who", "device", "distribution", "block", "detail", "skipped")
        for (who, device, distribution, block, detail, reason), rows in group(m.skipped(experiment), *columns).items():
            points = [count(row.number("points")) for row in rows if row.number("points") is not None]
            what = [f"{m.name}: {Contestant(m.name, who, device).name()}", distribution,
                    f"block {block}" if block else "",
                    f"{detail}" if detail and len({r.text('detail') for r in m.skipped(experiment)} - {''}) > 1 else "",
                    f"{listed(points)} points" if points else ""]
            lines.append(f"{', '.join(filter(None, what))}: {reason}")
    return ["Not measured:", "", *bullets(lines)] if lines else []


def hash_check(rows: Sequence[Row], several: bool) -> tuple[dict[tuple[str, str], str], list[str]]:
    """For each distribution and size "equal" or who differs; and the sentence above the table."""
    verdicts, bad = {}, []
    for case, found in hash_groups(rows).items():
        seen = sum(map(len, found.values()))
        if len(found) == 1:
            verdicts[case] = "equal" if seen > 1 else "only one"
            continue
        usual = max(found, key=lambda h: len(found[h]))
        clear = sum(len(v) == len(found[usual]) for v in found.values()) == 1
        others = [f"{named(row, several)} has {value}" for value, of in found.items() if value != usual or not clear
                  for row in of]
        verdicts[case] = "**DIFFERENT**"
        rest = f", the {len(found[usual])} others {usual}" if clear else ""
        bad.append(f"**DIFFERENT MESHES: {case[0]}, {count(to_number(case[1]))} points: {listed(others)}{rest}.**")
    if not verdicts:
        return {}, ["No row has a hash, so meshes cannot be compared.", ""]
    if bad:
        return verdicts, bullets(bad)
    compared = sum(v == "equal" for v in verdicts.values())
    return verdicts, [f"All hashes are equal in each of the {compared} cases with several meshes, over "
                      f"{len({named(r, several) for r in rows if r.text('hash')})} devices and programs.", ""]


def other_counts(rows: Sequence[Row]) -> list[str]:
    """Who has another number of triangles than cadt's exact mesh. cadt's own meshes are compared by their hashes."""
    exact = {(r.text("distribution"), r.text("points")): r.whole("triangles") for r in rows
             if r.text("who") in CADT and r.text("stabilize") != "paper" and r.whole("triangles") is not None}
    lines, compared = [], 0
    for (who, device, distribution), of in group([r for r in rows if r.text("who") not in CADT], "who", "device",
                                                 "distribution").items():
        known = [(r, exact[distribution, r.text("points")]) for r in of
                 if (distribution, r.text("points")) in exact and r.whole("triangles") is not None]
        compared += len(known)
        wrong = [f"{count(r.whole('triangles'))} of {count(right)} with {count(r.number('points'))} points"
                 for r, right in known if r.whole("triangles") != right]
        if wrong:
            lines.append(f"**Another number of triangles: {Contestant('', who, device).name()}, {distribution}: "
                         f"{listed(wrong)}.**")
    if compared and not lines:
        return [f"The other programs have as many triangles in each of {compared} cases.", ""]
    return bullets(lines)


def is_cadt(who: Contestant) -> bool:
    return who.who in CADT
