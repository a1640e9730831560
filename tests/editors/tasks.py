"""Ten tasks of an author of xacro, each done in the server by a client without a screen."""

from __future__ import annotations

import re
from pathlib import Path
from urllib.parse import unquote

from tests.server.client import Client


class Author:
    """An editor with one robot, which writes down what appears.

    Attributes:
        client: Connection to the server.
        path: The robot.
        macros: Its file of macros.
        lines: What appeared.
    """

    def __init__(self, client: Client, folder: Path) -> None:
        """Open both files of the robot."""
        self.client = client
        self.path, self.macros = folder / "arm.urdf.xacro", folder / "link.macro.xacro"
        self.lines: list[str] = []
        for path in (self.path, self.macros):
            client.open(path)

    def say(self, text: str) -> None:
        """Write a line."""
        self.lines.append(text)

    def find(self, path: Path, marked: str) -> tuple[int, int]:
        """Return the line and column of the mark ``|`` in a piece of the file's text."""
        text, _ = self.client.texts[path]
        start = text.index(marked.replace("|", "")) + marked.index("|")
        return text.count("\n", 0, start), start - text.rfind("\n", 0, start) - 1

    def ask(self, method: str, path: Path, marked: str, **more):
        """Ask a question at a mark."""
        return self.client.ask_at(f"textDocument/{method}", path, *self.find(path, marked), **more)

    def replace(self, path: Path, old: str, new: str) -> None:
        """Type other text in place of the first occurrence of a piece."""
        text, _ = self.client.texts[path]
        assert old in text
        self.client.change(path, text=text.replace(old, new, 1))

    def list_findings(self, path: Path, code: str = "") -> list[str]:
        """Return the shown findings, of one rule or of all."""
        shown = self.client.diagnostics.get(path.as_uri(), [])
        return [
            f"{path.name}:{one['range']['start']['line'] + 1}: {one['message']} [{one['code']}]"
            for one in shown
            if code in ("", one["code"])
        ]

    def list_actions(self, path: Path, code: str) -> list[dict]:
        """Return the actions that are offered for the first finding of a rule."""
        finding = self.client.list_found(path, code)[0]
        return self.client.ask(
            "textDocument/codeAction",
            textDocument={"uri": path.as_uri()},
            range=finding["range"],
            context={"diagnostics": [finding]},
        )

    def apply(self, edit: dict) -> list[str]:
        """Make the edits of the server; return each line that is new."""
        new = []
        for uri, edits in sorted(edit["changes"].items()):
            path = Path(unquote(uri.removeprefix("file://")))
            before = text = self.client.texts[path][0]
            starts = [0, *(match.end() for match in re.finditer("\n", text))]
            for one in sorted(edits, key=lambda one: -get_offset(starts, one, "start")):
                begin, end = (get_offset(starts, one, name) for name in ("start", "end"))
                text = text[:begin] + one["newText"] + text[end:]
            self.client.change(path, text=text)
            known = set(before.splitlines())
            new += [
                f"{path.name}:{number}: {line.strip()}"
                for number, line in enumerate(text.splitlines(), 1)
                if line not in known
            ]
        return new


def get_offset(starts: list[int], edit: dict, name: str) -> int:
    """Return the offset of a place of an edit."""
    place = edit["range"][name]
    return starts[place["line"]] + place["character"]


def list_places(found: list[dict]) -> list[str]:
    """Format locations of the server."""
    return sorted(
        f"{Path(one.get('targetUri') or one['uri']).name}:"
        f"{(one.get('targetSelectionRange') or one['range'])['start']['line'] + 1}"
        for one in found
    )


def do_tasks(author: Author) -> str:
    """Do the ten tasks; return what appeared."""
    client, path, macros = author.client, author.path, author.macros
    tasks = iter(range(1, 11))

    def begin(title: str) -> None:
        author.say(f"{next(tasks)}. {title}")

    def tell(*texts: str) -> None:
        for text in texts:
            author.say(f"   {text}")

    begin("What is wrong with this robot?")
    client.wait_for(path, "mesh-not-found")
    client.wait_for(macros, "inertia-triangle-inequality")
    tell(*author.list_findings(path), *author.list_findings(macros))

    begin("What is this expression worth?  ${length / 2} in link.macro.xacro")
    tell(*author.ask("hover", macros, "0 0 ${len|gth / 2}")["contents"]["value"].splitlines())

    begin("Where does this call go, and where is the macro used?")
    tell(
        "definition: " + ", ".join(list_places(author.ask("definition", path, "<xacro:arm_l|ink")))
    )
    uses = author.ask(
        "references", macros, 'macro name="arm_l|ink"', context={"includeDeclaration": False}
    )
    tell("references: " + ", ".join(list_places(uses)))

    begin("Call the macro again: what does it take?")
    call = '  <xacro:arm_link name="spare" />\n</robot>'
    author.replace(path, "</robot>", call)
    shown = author.ask("completion", path, '<xacro:arm_link name="spare" |/>')
    tell("offered: " + " ".join(one["label"] for one in shown["items"]))

    begin("Stop in the middle of the tag: do the findings stay?")
    author.replace(path, '"spare" />', '"spare" ')
    client.wait_for(path, "not-well-formed")
    tell(*author.list_findings(path))
    author.replace(path, '  <xacro:arm_link name="spare" \n', "")
    client.wait_until(lambda: not client.list_found(path, "not-well-formed"))

    begin('Which link may a child be?  <child link="')
    shown = author.ask("completion", path, '<child link="${prefix}base_link|"')
    tell("offered: " + " ".join(one["label"] for one in shown["items"]))

    begin("Correct the misspelled limit")
    (fix, *_) = actions = author.list_actions(path, "unknown-attribute")
    tell(*(f"action: {one['title']}" for one in actions))
    tell(*author.apply(fix["edit"]))
    client.wait_until(lambda: not client.list_found(path, "unknown-attribute"))

    begin("A finding that is meant so: suppress it here")
    actions = author.list_actions(path, "missing-inertial")
    tell(*author.apply(next(one for one in actions if "Suppress" in one["title"])["edit"]))
    client.wait_until(lambda: not client.list_found(path, "missing-inertial"))
    tell(*author.list_findings(path), *author.list_findings(macros))

    begin("Rename a parameter of the macro: length to height")
    edit = author.ask("rename", macros, 'params="name radius len|gth', newName="height")
    tell(*author.apply(edit))

    begin("The kinematic tree")
    outline = client.ask("textDocument/documentSymbol", textDocument={"uri": path.as_uri()})
    tell(*list_outline(outline))
    return "\n".join(line.rstrip() for line in author.lines) + "\n"


def list_outline(symbols: list[dict], indent: str = "") -> list[str]:
    """Format the outline."""
    lines = []
    for one in symbols:
        lines.append(f"{indent}{one['name']}")
        lines += list_outline(one.get("children") or [], indent + "  ")
    return lines
