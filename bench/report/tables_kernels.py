# SPDX-License-Identifier: Apache-2.0
"""Tables of the kernels: launches, time, bandwidth, and what a profiler counted."""
from collections.abc import Sequence

from rows import Machine, Row, per_device, ratio
from words import NONE, bullets, count, number, percent, significant, table

HEAD = ("kernel", "launches", "time, ms", "share", "bytes at least, MB", "bandwidth, GB/s", "of a copy",
        "issue slots used", "memory used, by the profiler", "operations a byte")


def kernels(machines: Sequence[Machine], paper: dict) -> list[str]:
    lines, sentences, several = [], [], len(machines) > 1
    for machine, who, rows in per_device(machines, "kernels"):
        name = f"{machine.name}: {who.name()}" if several else who.name()
        sentences += said(name, rows)
        lines += [f"### {name}, {count(rows[0].number('points'))} points", "", *table(HEAD, map(line, rows))]
    if lines:
        sentences.append("The bytes are those that a kernel must move whatever the input is (bench/kernel_bytes.cpp); "
                         "what caches still hold may make a bandwidth higher than that of a copy.")
    return bullets(sentences) + lines


def said(name: str, rows: Sequence[Row]) -> list[str]:
    sum_ms, whole = sum(row.number("kernel_ms") or 0 for row in rows), rows[0].number("device_ms")
    text = f"{name}: kernels take {number(sum_ms)} ms"
    if whole:
        text += f" of {number(whole)} ms on the device ({percent(sum_ms / whole)})"
    text += f"; a copy moves {number(rows[0].number('copy_gbs'))} GB/s."
    reason = next((row.text("profiler") for row in rows if row.text("profiler") not in ("", "ncu")), "")
    return [text + (f" Not profiled: {reason}." if reason else "")]


def line(row: Row) -> list[str]:
    size, share = row.number("kernel_bytes"), ratio(row.number("bandwidth_gbs"), row.number("copy_gbs"))
    used = [percent(ratio(row.number(c), 100)) for c in ("issue_active", "dram_throughput")]
    operations = ratio(row.number("operations"), row.number("dram_bytes"))
    return [row.text("kernel"), count(row.number("kernel_launches")), number(row.number("kernel_ms")),
            percent(row.number("kernel_share")), NONE if size is None else significant(size / 1e6),
            number(row.number("bandwidth_gbs")), percent(share), *used,
            NONE if operations is None else significant(operations)]
