"""Places where a word of the list is right."""

EXCEPTIONS: tuple[tuple[str, str, str], ...] = (
    (r"tests/language/", r".", "lists the words"),
    (r"rules/old_names|tests/", r"-in-millimetres", "old names of rules"),
    (r"rules/collision/axle\.py", r"tire\|tyre", "matches names of links in both spellings"),
    (r"docs/(?:index|start)\.md", r"I want to", "the heading of a table of tasks"),
    (r"docs/conf\.py", r"howto/strangers", "the old address of a page"),
    (r"docs/formats/sdf\.md", r"^\d+ materials of Gazebo", "names of materials of Gazebo"),
    (
        r"docs/(?:measurements/verify|formats/sdf)\.md",
        r"\| colours",
        "a row that export --verify prints",
    ),
    (r"model/gazebo_colors\.py", r"Grey", "names of materials of Gazebo"),
    (r"docs/howto/classic-to-gz\.md", r"Gazebo/Grey", "names of materials of Gazebo"),
    (r"docs/rules/renamed-rule\.md", r"-in-millimetres", "an old name of a rule"),
    (r"lint/fix_run\.py", r"Mended", "an old name of a class"),
    (r"commands/(?:collision|export)\.md|report/collision\.py", r"\"centre\"|^colours ", "in JSON"),
    (r"CHANGELOG", r".", "keeps what was printed"),
    (r"commands/simulate|simulation/checks|docs/", r"--limp", "an option that users know"),
    (r"checks/final_state|report/simulate\.py", r"``centre``|\"centre\"", "an old name in JSON"),
)
"""A pattern of paths, one of lines, and the reason."""
