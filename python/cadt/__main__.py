# SPDX-License-Identifier: Apache-2.0
"""``python -m cadt``: the program ``cadt``."""

import os
import sys

from cadt._program import main

if __name__ == "__main__":
    sys.argv[0] = os.path.join(os.path.dirname(sys.executable), "cadt")  # the scripts of this Python are there
    sys.exit(main())
