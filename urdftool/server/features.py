"""The requests and notifications of an editor that are answered."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, BinaryIO, cast

from lsprotocol import types as lsp
from pygls import uris
from pygls.exceptions import JsonRpcException

from .answer_stream import AnswerStream
from .protocol import RobotServer, ServerSettings

FIX_ALL = "source.fixAll.urdftool"


def serve(settings: ServerSettings, stdin: BinaryIO, stdout: AnswerStream) -> None:
    """Serve one editor until it ends."""
    server = RobotServer(settings)
    add_features(server)
    server.start_io(stdin, cast("BinaryIO", stdout))


def add_features(server: RobotServer) -> None:
    """Declare everything that the server answers."""
    _add_documents(server)
    _add_actions(server)
    _add_reading(server)
    _add_completion(server)
    _add_renaming(server)


def _add_documents(server: RobotServer) -> None:
    @server.feature(lsp.INITIALIZED)
    async def start(ls: RobotServer, _: lsp.InitializedParams) -> None:
        folders = [uris.to_fs_path(uri) for uri in ls.workspace.folders]
        root = ls.workspace.root_path
        known = [folder for folder in folders if folder] or ([root] if root else [])
        ls.start_worker(known)
        ls.watch_files()
        await ls.watch_editor()

    @server.feature(lsp.TEXT_DOCUMENT_DID_OPEN)
    async def open_document(ls: RobotServer, params: lsp.DidOpenTextDocumentParams) -> None:
        ls.open_document(params.text_document.uri, params.text_document.text)

    @server.feature(lsp.TEXT_DOCUMENT_DID_CHANGE)
    async def change(ls: RobotServer, params: lsp.DidChangeTextDocumentParams) -> None:
        uri = params.text_document.uri
        text = ls.workspace.get_text_document(uri).source
        ls.change_document(uri, text, params.content_changes)

    @server.feature(lsp.TEXT_DOCUMENT_DID_CLOSE)
    async def close(ls: RobotServer, params: lsp.DidCloseTextDocumentParams) -> None:
        ls.close_document(params.text_document.uri)

    @server.feature(lsp.TEXT_DOCUMENT_DID_SAVE)
    async def save(ls: RobotServer, _: lsp.DidSaveTextDocumentParams) -> None:
        await ls.refresh()

    @server.feature(lsp.WORKSPACE_DID_CHANGE_WATCHED_FILES)
    async def change_files(ls: RobotServer, _: lsp.DidChangeWatchedFilesParams) -> None:
        await ls.refresh()


def _add_actions(server: RobotServer) -> None:
    kinds = [lsp.CodeActionKind.QuickFix, FIX_ALL]

    @server.feature(lsp.TEXT_DOCUMENT_CODE_ACTION, lsp.CodeActionOptions(code_action_kinds=kinds))
    async def act(ls: RobotServer, params: lsp.CodeActionParams) -> list[lsp.CodeAction]:
        path = ls.find_path(params.text_document.uri)
        if path is None:
            return []
        only = params.context.only
        found: list[lsp.CodeAction] = []
        if only is None or any(_is_included(kind, "quickfix") for kind in only):
            span = ls.converter.unstructure(params.range)
            actions = await ls.ask("actions", {"path": path, "range": span}) or []
            found += [_make_action(ls, one, params.context.diagnostics) for one in actions]
        if only is not None and any(_is_included(kind, FIX_ALL) for kind in only):
            edits = await ls.ask("fix-all", {"path": path})
            if edits:
                edit = ls.make_workspace_edit(edits)
                found.append(lsp.CodeAction("Apply all safe fixes", kind=FIX_ALL, edit=edit))
        return found

    @server.feature(lsp.TEXT_DOCUMENT_FORMATTING)
    async def format_document(
        ls: RobotServer, params: lsp.DocumentFormattingParams
    ) -> list[lsp.TextEdit] | None:
        edits = await _ask(ls, "format", params)
        return ls.converter.structure(edits, list[lsp.TextEdit]) if edits else None


def _is_included(kind: object, other: str) -> bool:
    """Tell whether a kind of action that an editor asks for includes another."""
    kind_name = str(getattr(kind, "value", kind))
    return other == kind_name or other.startswith(kind_name + ".") or not kind_name


def _make_action(
    ls: RobotServer, action: dict[str, Any], shown: Sequence[lsp.Diagnostic]
) -> lsp.CodeAction:
    disabled = action.get("disabled")
    return lsp.CodeAction(
        action["title"],
        kind=action["kind"],
        diagnostics=[one for one in shown if one.code == action["code"]],
        is_preferred=action.get("preferred") or None,
        disabled=lsp.CodeActionDisabled(disabled) if disabled else None,
        edit=ls.make_workspace_edit(action["edits"]) if action["edits"] else None,
    )


async def _ask(ls: RobotServer, method: str, params: Any, **more: Any) -> Any:
    """Ask about a document, at the position of a request if it has one."""
    path = ls.find_path(params.text_document.uri)
    if path is None:
        return None
    question = {"path": path, **more}
    if hasattr(params, "position"):
        question["position"] = ls.converter.unstructure(params.position)
    return ls.with_uris(await ls.ask(method, question))


def _add_reading(server: RobotServer) -> None:
    @server.feature(lsp.TEXT_DOCUMENT_HOVER)
    async def hover(ls: RobotServer, params: lsp.HoverParams) -> lsp.Hover | None:
        found = await _ask(ls, "hover", params)
        return ls.converter.structure(found, lsp.Hover) if found else None

    @server.feature(lsp.TEXT_DOCUMENT_DEFINITION)
    async def find_definition(ls: RobotServer, params: lsp.DefinitionParams) -> list[lsp.Location]:
        found = await _ask(ls, "definition", params) or []
        return ls.converter.structure(found, list[lsp.Location])

    @server.feature(lsp.TEXT_DOCUMENT_REFERENCES)
    async def find_references(ls: RobotServer, params: lsp.ReferenceParams) -> list[lsp.Location]:
        declaration = params.context.include_declaration
        found = await _ask(ls, "references", params, declaration=declaration) or []
        return ls.converter.structure(found, list[lsp.Location])

    @server.feature(lsp.TEXT_DOCUMENT_DOCUMENT_SYMBOL)
    async def list_symbols(
        ls: RobotServer, params: lsp.DocumentSymbolParams
    ) -> list[lsp.DocumentSymbol]:
        found = await _ask(ls, "symbols", params) or []
        return ls.converter.structure(found, list[lsp.DocumentSymbol])


def _add_completion(server: RobotServer) -> None:
    options = lsp.CompletionOptions(trigger_characters=list("<\"' :/{(.$"))

    @server.feature(lsp.TEXT_DOCUMENT_COMPLETION, options)
    async def complete(ls: RobotServer, params: lsp.CompletionParams) -> lsp.CompletionList:
        found = await _ask(ls, "completion", params, snippets=_has_snippets(ls)) or []
        items = ls.converter.structure(found, list[lsp.CompletionItem])
        return lsp.CompletionList(is_incomplete=False, items=items)


def _add_renaming(server: RobotServer) -> None:
    @server.feature(lsp.TEXT_DOCUMENT_PREPARE_RENAME)
    async def prepare(
        ls: RobotServer, params: lsp.PrepareRenameParams
    ) -> lsp.PrepareRenamePlaceholder | None:
        found = await _ask(ls, "prepare-rename", params)
        return ls.converter.structure(found, lsp.PrepareRenamePlaceholder) if found else None

    @server.feature(lsp.TEXT_DOCUMENT_RENAME, lsp.RenameOptions(prepare_provider=True))
    async def rename(ls: RobotServer, params: lsp.RenameParams) -> lsp.WorkspaceEdit | None:
        found = await _ask(ls, "rename", params, name=params.new_name)
        if found is None:
            return None
        if "refused" in found:
            raise JsonRpcException(found["refused"], lsp.LSPErrorCodes.RequestFailed.value)
        return ls.make_workspace_edit(found["edits"])


def _has_snippets(ls: RobotServer) -> bool:
    """Tell whether the editor moves the cursor into an inserted attribute."""
    document = ls.client_capabilities.text_document
    completion = document.completion if document is not None else None
    item = completion.completion_item if completion is not None else None
    return bool(item is not None and item.snippet_support)
