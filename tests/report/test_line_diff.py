"""A diff gives the new text from the old one, and shows no more than what changed."""

import subprocess

import pytest
from hypothesis import given
from hypothesis import strategies as st

from urdftool.report.file_diff import format_unified_lines

FEW = st.lists(st.sampled_from(["<link>\n", "</link>\n", "a\n", "b\n", "c\n"]), max_size=30)


def applied(old, diff):
    """The old lines with a diff applied; fails where the diff does not fit."""
    new, at = [], 0
    for line in diff[2:]:
        if line.startswith("@@"):
            first, _, count = line.split()[1][1:].partition(",")
            start = int(first) - (count != "0")
            new += old[at:start]
            at = start
        elif line.startswith("+"):
            new.append(line[1:])
        else:
            assert old[at] == line[1:]
            at += 1
            new += [line[1:]] if line.startswith(" ") else []
    return new + old[at:]


@given(FEW, FEW, st.integers(0, 4))
def test_a_diff_makes_the_new_of_the_old(old, new, around):
    diff = list(format_unified_lines(old, new, "a", "b", around=around))
    assert applied(old, diff) == new
    assert bool(diff) == (old != new)


def test_changes_among_lines_that_repeat_are_all_that_is_shown():
    link = ['  <link name="l{}">\n', "    <inertial>\n", '      <mass value="0"/>\n']
    link += ["      <inertia/>\n", "    </inertial>\n", "  </link>\n"]
    old = [line.format(n) for n in range(300) for line in link]
    new = [
        line
        for n in range(300)
        for line in ([old[6 * n], old[6 * n + 5]] if n % 3 == 0 else old[6 * n : 6 * n + 6])
    ]
    diff = list(format_unified_lines(old, new, "a", "a"))
    changed = [line for line in diff[2:] if line[0] in "+-"]
    assert len(changed) == 100 * 4
    assert {line[0] for line in changed} == {"-"}


@pytest.mark.program("patch")
def test_patch_takes_it(tmp_path):
    old = ["a\n", "b\n", "c\n", "d\n", "e\n", "f\n", "g\n", "h\n", "i\n"]
    new = ["new\n", *old[:4], *old[5:], "z\n"]
    (tmp_path / "a").write_text("".join(old))
    diff = "".join(format_unified_lines(old, new, "a", "a", around=1))
    subprocess.run(["patch", "-p0", "-s"], cwd=tmp_path, input=diff, text=True, check=True)
    assert (tmp_path / "a").read_text() == "".join(new)
