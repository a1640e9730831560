"""Print the text to rewrite: ``python -m tests.language [--count] [PATH ...]``."""

from __future__ import annotations

import sys
from collections import Counter
from pathlib import Path

from .check import ROOT, find_remarks

arguments = [word for word in sys.argv[1:] if not word.startswith("--")]
remarks = list(find_remarks([Path(word).resolve() for word in arguments] or [ROOT / "urdftool"]))
if "--count" in sys.argv:
    for (folder, kind), count in sorted(
        Counter(("/".join(r.path.split("/")[:2]), r.kind) for r in remarks).items()
    ):
        print(f"{count:5} {kind:10} {folder}")
else:
    for remark in remarks:
        print(f"{remark.path}:{remark.line}: {remark.kind} '{remark.found}' -> {remark.write}")
