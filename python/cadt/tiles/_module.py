# SPDX-License-Identifier: Apache-2.0
"""What builds of the extension module without tiles lack."""

from __future__ import annotations

from cadt import _cadt

if not hasattr(_cadt, "TileTree"):
    raise ImportError(
        "this build of cadt has no tiles: they need Linux or macOS, and nlohmann_json and xxHash when cadt is built "
        "(Debian, Ubuntu: nlohmann-json3-dev libxxhash-dev)"
    )
