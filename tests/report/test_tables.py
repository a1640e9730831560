from urdftool.report.tables import render_table


def test_columns_are_as_wide_as_their_cells():
    rows = [("", "method", "n"), ("a b", "hull", "10"), ("link_long", "", "7")]
    assert render_table(rows, left=(0, 1)) == (
        "           method   n\na b        hull    10\nlink_long           7\n"
    )
    assert render_table([]) == ""


def test_wide_characters_take_two_columns():
    assert render_table([("腕", "1"), ("abc", "2")]) == "腕   1\nabc  2\n"


def test_text_is_neither_markup_nor_a_control_sequence():
    rows = [("[red]x[/red] :smile:", "\x1b[2J")]
    assert render_table(rows, left=(0, 1)) == "[red]x[/red] :smile:  \\x1b[2J\n"
    long = "x" * 5000
    assert render_table([(long, long)]) == f"{long}  {long}\n"


def test_colors_only_where_they_are_wanted(monkeypatch):
    monkeypatch.setenv("NO_COLOR", "1")  # the caller has decided
    rows = [("a", ("wrong", "red"))]
    assert render_table(rows, left=(0, 1)) == "a  wrong\n"
    assert render_table(rows, left=(0, 1), colors=True) == "a  \x1b[31mwrong\x1b[0m\n"


def test_a_rule_below_the_heads():
    assert render_table([("a", "worst"), ("long", "1")], left=(0, 1), rule=True) == (
        "a     worst\n----  -----\nlong  1\n"
    )
