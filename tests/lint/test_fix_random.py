"""Fixes of random robots, laid out at random: well-formed, and not a byte changed beyond the fix.

A robot with one fault is written with comments, blanks, quotes, references and orders of attributes
that hypothesis chooses. Its fix is known as bytes: one piece of the file becomes another, and the
rest stays as it is.
"""

import os
from xml.parsers import expat

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from urdftool.lint.fix_run import fix_description
from urdftool.lint.options import Options
from urdftool.lint.run import check_file
from urdftool.lint.settings import Settings

FAULTS = {
    # rule: what stands in a joint, how it is written, and what becomes of it
    "axis-not-unit": ("axis", "<axis{}xyz={q}0 0 4{q}{}/>", "<axis{}xyz={q}0 0 1{q}{}/>"),
    "lower-above-upper": (
        "limit",
        "<limit{}lower={q}2{q} effort={q}1{q}{}upper={q}1{q} velocity={q}1{q}/>",
        "<limit{}lower={q}1{q} effort={q}1{q}{}upper={q}2{q} velocity={q}1{q}/>",
    ),
    "negative-limit": (
        "limit",
        "<limit{}lower={q}1{q} effort={q}-3{q}{}upper={q}2{q} velocity={q}1{q}/>",
        "<limit{}lower={q}1{q} effort={q}3{q}{}upper={q}2{q} velocity={q}1{q}/>",
    ),
    "unknown-attribute": (
        "limit",
        "<limit{}lower={q}1{q} uper={q}2{q}{}effort={q}1{q} velocity={q}1{q}/>",
        "<limit{}lower={q}1{q} upper={q}2{q}{}effort={q}1{q} velocity={q}1{q}/>",
    ),
    "wrong-case-keyword": (
        "limit",
        "<Limit{}lower={q}1{q}{}upper={q}2{q} effort={q}1{q} velocity={q}1{q}>{b}</Limit >",
        "<limit{}lower={q}1{q}{}upper={q}2{q} effort={q}1{q} velocity={q}1{q}>{b}</limit >",
    ),
    "rpy-in-degrees": (
        "origin",
        "<origin{}rpy={q}90 0 0{q}{}/>",
        "<origin{}rpy={q}1.5708 0 0{q}{}/>",
    ),
    "padded-reference": ("parent", "<parent{}link={q}base {q}{}/>", "<parent{}link={q}base{q}{}/>"),
    "not-a-number": (
        "limit",
        "<limit{}lower={q}1{q} upper={q}2,5{q}{}effort={q}1{q} velocity={q}1{q}/>",
        "<limit{}lower={q}1{q} upper={q}2.5{q}{}effort={q}1{q} velocity={q}1{q}/>",
    ),
    "empty-dynamics": ("dynamics", "<dynamics{}{}/>", ""),
    "dynamics-as-child-elements": (
        "dynamics",
        "<dynamics><damping>{b}0.5</damping></dynamics>",
        '<dynamics damping="0.5"/>',
    ),
}

blank = st.text(alphabet=" \t\n", min_size=1, max_size=4)
blanks = st.text(alphabet=" \t\n", max_size=4)
text = st.text(st.characters(codec="utf-8", exclude_characters="-<>&\"'\r", min_codepoint=32))
comment = text.map(lambda inside: f"<!--{inside} -->")
misc = st.one_of(blanks, comment, st.just("<?note here?>"))
quote = st.sampled_from("\"'")


@st.composite
def robots(draw):
    """A rule, a robot with a fault of it, and the robot without."""
    rule = draw(st.sampled_from(sorted(FAULTS)))
    q, b = draw(quote), draw(blanks)
    one, two = draw(blank), draw(blank)
    slot, *pair = FAULTS[rule]
    pair = [part.format(one, two, q=q, b=b) for part in pair]
    name = draw(st.sampled_from(["arm", "a&amp;b", "&#97;rm", "arm&#x31;"]))
    parts = {
        "limit": '<limit lower="1" upper="2" effort="1" velocity="1"/>',
        "axis": '<axis xyz="0 0 1"/>',
        "parent": "<parent link='base'/>",
        "child": f"<child link={q}{name}{q}/>",
    }
    written = {fault: {**parts, slot: fault} for fault in pair}
    order = draw(st.permutations(sorted({*parts, slot})))
    between = [draw(misc) for _ in range(len(order) + 6)]
    attributes = draw(st.permutations([f"name={q}swing{q}", "type='revolute'"]))
    prolog = draw(st.sampled_from(["", "<?xml version='1.0'?>", '<?xml version="1.0"?>\n']))
    files = []
    for fault in pair:
        inside = "".join(
            f"{between[i]}{written[fault].get(tag, '')}" for i, tag in enumerate(order)
        )
        files.append(
            f"{prolog}{between[-1]}<robot name='r'>{between[-2]}<link name={q}base{q}/>"
            f"{between[-3]}<link name={q}{name}{q}/>{between[-4]}"
            f"<joint {' '.join(attributes)}>{inside}{between[-5]}</joint>{between[-6]}</robot>"
        )
    end = draw(st.sampled_from(["\n", "\r\n"]))
    mark = draw(st.sampled_from(["", "\ufeff"]))
    tail = draw(st.sampled_from(["", "\n"]))
    data = [(mark + (file + tail).replace("\n", end)).encode("utf-8") for file in files]
    return rule, data[0], data[1]


def check(path, case):
    rule, bad, good = case
    path.write_bytes(bad)
    os.chdir(path.parent)
    options = Options(Settings(select=(rule,)), fixes=True)
    report = check_file(path.name, options)
    assert [f.code for f in report.findings] == [rule], report.findings
    result = fix_description(report, options, unsafe=True)
    assert not result.broken
    fixed = result.after[path.name]
    expat.ParserCreate().Parse(fixed, True)
    if rule != "empty-dynamics":  # whose line goes with it where it has one
        assert fixed == good
    else:
        assert fixed.split() == good.split()
    assert not result.report.findings
    path.write_bytes(fixed)
    assert not fix_description(check_file(path.name, options), options, unsafe=True).after


common = {
    "derandomize": True,
    "deadline": None,
    "suppress_health_check": [HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
}


@given(robots())
@settings(max_examples=25, **common)
def test_some_random_fixes(tmp_path, monkeypatch, case):
    monkeypatch.chdir(tmp_path)
    check(tmp_path / "r.urdf", case)


@pytest.mark.slow
@given(robots())
@settings(max_examples=1000, **common)
def test_a_thousand_random_fixes(tmp_path, monkeypatch, case):
    monkeypatch.chdir(tmp_path)
    check(tmp_path / "r.urdf", case)
