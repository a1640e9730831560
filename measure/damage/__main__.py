"""``python -m measure.damage [SEEDS [KIND …]]``: the table of damages."""

import sys

from .robots import samples
from .run import table

robots = samples()
seeds = int(sys.argv[1]) if len(sys.argv) > 1 else 1
rows = table(robots, seeds, sys.argv[2:] or None)
for kind, (tried, found, missed) in rows.items():
    print(f"{kind.replace('_', ' '):36} {found:4} of {tried:4}")
    for line in missed:
        print(f"    {line}")
tried, found = (sum(row[i] for row in rows.values()) for i in (0, 1))
print(f"{len(robots)} robots, {len(rows)} kinds: {found} of {tried} = {100 * found / tried:.1f} %")
