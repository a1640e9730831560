"""Each feature of the server once, driven by pytest-lsp, the client of pygls for tests."""

import sys

import pytest

pytest.importorskip("pygls")
pytest_lsp = pytest.importorskip("pytest_lsp")

from lsprotocol import types as lsp  # noqa: E402

from tests.server.test_navigation import LIBRARY, MAIN, find  # noqa: E402

COMMAND = [sys.executable, "-m", "urdftool", "server"]
TITLE = "Fix: write the unit axis"
AXIS = MAIN.replace('"fixed"><parent', '"continuous"><axis xyz="0 1 1"/><parent')


@pytest_lsp.fixture(config=pytest_lsp.ClientServerConfig(server_command=COMMAND))
async def client(lsp_client: pytest_lsp.LanguageClient, tmp_path):
    """Start a server whose workspace has the robot and its macros."""
    folder = tmp_path.resolve()
    (folder / "library.xacro").write_text(LIBRARY)
    (folder / "one.urdf.xacro").write_text(AXIS)
    (folder / "package.xml").write_text("<package><name>one</name></package>")
    (folder / "base.stl").write_bytes(bytes(84))
    capabilities = pytest_lsp.client_capabilities("neovim")
    uri = folder.as_uri()
    workspace = [lsp.WorkspaceFolder(uri, "one")]
    await lsp_client.initialize_session(
        lsp.InitializeParams(capabilities, root_uri=uri, workspace_folders=workspace)
    )
    yield
    await lsp_client.shutdown_session()


def ask(uri, marked, text=AXIS):
    """Return the parameters of a question at the mark ``|``."""
    line, character = find(text, marked)
    return {
        "text_document": lsp.TextDocumentIdentifier(uri),
        "position": lsp.Position(line, character),
    }


@pytest.mark.asyncio
async def test_each_feature(client, tmp_path):
    main = (tmp_path.resolve() / "one.urdf.xacro").as_uri()
    document = lsp.TextDocumentItem(main, "xml", 1, AXIS)
    client.text_document_did_open(lsp.DidOpenTextDocumentParams(document))
    while not any(one.code == "axis-not-unit" for one in client.diagnostics.get(main, ())):
        await client.wait_for_notification(lsp.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)
    (finding,) = (one for one in client.diagnostics[main] if one.code == "axis-not-unit")
    assert "axis-not-unit" not in finding.message
    assert finding.code_description.href.endswith("joint.html")

    identifier = lsp.TextDocumentIdentifier(main)
    context = lsp.CodeActionContext([finding])
    actions = await client.text_document_code_action_async(
        lsp.CodeActionParams(identifier, finding.range, context)
    )
    assert any(one.edit for one in actions)
    hover = await client.text_document_hover_async(lsp.HoverParams(**ask(main, 'name="tu|rn"')))
    assert "joint **turn**" in hover.contents.value
    found = await client.text_document_definition_async(
        lsp.DefinitionParams(**ask(main, 'child link="left|_bar"'))
    )
    assert [one.uri.rpartition("/")[2] for one in found] == ["library.xacro"]
    uses = await client.text_document_references_async(
        lsp.ReferenceParams(lsp.ReferenceContext(True), **ask(main, 'parent link="ba|se"'))
    )
    assert len(uses) == 2
    symbols = await client.text_document_document_symbol_async(lsp.DocumentSymbolParams(identifier))
    assert symbols[0].name == "base"
    items = await client.text_document_completion_async(
        lsp.CompletionParams(**ask(main, 'parent link="|base"'))
    )
    assert "left_bar" in [one.label for one in items.items]
    place = ask(main, 'parent link="ba|se"')
    prepared = await client.text_document_prepare_rename_async(lsp.PrepareRenameParams(**place))
    assert prepared.placeholder == "base"
    renamed = await client.text_document_rename_async(lsp.RenameParams(new_name="chassis", **place))
    assert len(renamed.changes[main]) == 2
    options = lsp.FormattingOptions(tab_size=2, insert_spaces=True)
    edits = await client.text_document_formatting_async(
        lsp.DocumentFormattingParams(identifier, options)
    )
    assert edits
