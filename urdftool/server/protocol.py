"""The Language Server Protocol over standard input and output, by pygls."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from lsprotocol import converters
from lsprotocol import types as lsp
from pygls import uris
from pygls.exceptions import JsonRpcException, JsonRpcInvalidParams
from pygls.lsp.server import LanguageServer
from pygls.protocol import LanguageServerProtocol

from .. import __version__
from .moves import compare_texts, make_change
from .publication import Publication
from .worker_process import PATIENCE, WorkerProcess

WATCH = 3.0
"""Time [s] between looks at whether the process of the editor exists; chosen."""

WATCHED = "**/*.{urdf,xacro,srdf,sdf,mjcf,xml,yaml,yml,toml,stl,dae,obj,glb,launch,py,txt}"
"""Files that a check may read; chosen, those that the extension of VS Code watches."""

QUIET = 0.05
"""Time [s] without an edit before a check; chosen: keys of a fast typist are 0.1 s apart."""


@dataclass(frozen=True)
class ServerSettings:
    """Settings of the command line.

    Attributes:
        packages: Folders by package name.
        package_paths: Folders that contain packages.
        targets: Simulators and middleware; if empty, they are inferred.
        select: Rules to check; None for the default ones.
        ignore: Rules to skip.
        quiet: Time [s] without an edit before a check.
        patience: Time [s] without an answer after which the checking process is killed.
    """

    packages: Mapping[str, str]
    package_paths: Sequence[str] = ()
    targets: Sequence[str] = ()
    select: Sequence[str] | None = None
    ignore: Sequence[str] = ()
    quiet: float = QUIET
    patience: float = PATIENCE


class AnsweringProtocol(LanguageServerProtocol):
    """Protocol that answers requests with malformed parameters, which pygls only logs."""

    def structure_message(self, data: dict[str, Any]) -> Any:
        """Return the message of an object of JSON.

        Raises:
            JsonRpcException: It is malformed; a request is answered with "invalid params".
        """
        try:
            return super().structure_message(data)
        except JsonRpcException:
            if "id" in data and "method" in data:
                self._send_response(data["id"], error=JsonRpcInvalidParams().to_response_error())
            raise


class RobotServer(LanguageServer):
    """Language server of robot descriptions."""

    def __init__(self, settings: ServerSettings) -> None:
        """Create a server that answers what :func:`add_features` declares."""
        super().__init__("urdftool", __version__, protocol_cls=AnsweringProtocol)
        self.settings = settings
        self.worker = WorkerProcess(self.log, settings.patience)
        self.publication = Publication()
        self.converter = converters.get_converter()
        self._texts: dict[str, str] = {}
        self._uris: dict[str, list[str]] = {}  # of a path, the one opened last at the end
        self._robots: dict[str, list[str]] = {}
        self._changed: set[str] = set()
        self._check: asyncio.Task[None] | None = None
        self._ready: asyncio.Task[None] | None = None

    # Names and messages --------------------------------------------------------------------

    def log(self, message: str) -> None:
        """Write a line to the log of the editor."""
        self.window_log_message(lsp.LogMessageParams(lsp.MessageType.Warning, message))

    @property
    def encoding(self) -> str:
        """Return the unit of columns that both sides agreed on."""
        found = self.server_capabilities.position_encoding
        return str(
            found.value if isinstance(found, lsp.PositionEncodingKind) else found or "utf-16"
        )

    def make_uri(self, path: str) -> str:
        """Return the address of a file as the editor writes it."""
        return self._list_uris(path)[-1]

    def _list_uris(self, path: str) -> list[str]:
        """Return the addresses of a file: of a document that is open through a link, several."""
        return self._uris.get(path) or [uris.from_fs_path(path) or path]

    def find_path(self, uri: str) -> str | None:
        """Return the resolved path of an address; None for one that is not a file."""
        path = uris.to_fs_path(uri) if uri.startswith("file:") else None
        return None if path is None else os.path.realpath(path)

    # Documents -----------------------------------------------------------------------------

    def start_worker(self, folders: Iterable[str]) -> None:
        """Start the checking process, with the folders of the workspace."""
        settings = {
            "encoding": self.encoding,
            "folders": list(folders),
            "packages": {name: os.path.abspath(p) for name, p in self.settings.packages.items()},
            "package_paths": [os.path.abspath(path) for path in self.settings.package_paths],
            "targets": list(self.settings.targets),
            "select": None if self.settings.select is None else list(self.settings.select),
            "ignore": list(self.settings.ignore),
        }
        self._ready = asyncio.get_running_loop().create_task(self.worker.configure(settings))

    def open_document(self, uri: str, text: str) -> None:
        """Check a document that was opened."""
        path = self.find_path(uri)
        if path is not None:
            known = self._uris.setdefault(path, [])
            known[:] = [*(one for one in known if one != uri), uri]
            self._set_text(path, text)

    def change_document(
        self, uri: str, text: str, changes: Sequence[lsp.TextDocumentContentChangeEvent]
    ) -> None:
        """Move the findings of a document by its edits, and check it when it is quiet."""
        path = self.find_path(uri)
        if path is None:
            return
        for change in changes:
            if isinstance(change, lsp.TextDocumentContentChangePartial):
                start, end = change.range.start, change.range.end
                moved = make_change(
                    (start.line, start.character),
                    (end.line, end.character),
                    change.text,
                    self.encoding,
                )
            else:
                moved = compare_texts(self._texts.get(path, ""), text, self.encoding)
            self.publication.move(path, moved)
        self._set_text(path, text)

    def close_document(self, uri: str) -> None:
        """Forget a document; robots without an open document have no diagnostics."""
        path = self.find_path(uri)
        if path is None:
            return
        rest = [one for one in self._uris.get(path, ()) if one != uri]
        if rest:  # open through a link, too
            self._uris[path] = rest
            self.text_document_publish_diagnostics(lsp.PublishDiagnosticsParams(uri, []))
            self._set_text(path, self.workspace.get_text_document(rest[-1]).source)
            return
        self._texts.pop(path, None)
        self._robots.pop(path, None)
        self.worker.set_document(path, None)
        self._publish(self.publication.keep(self._list_robots()))
        self._uris.pop(path, None)
        self.schedule(self._texts)

    def _set_text(self, path: str, text: str) -> None:
        self._texts[path] = text
        self.worker.set_document(path, text)
        self.schedule([path])

    def _list_robots(self) -> set[str]:
        return {robot for robots in self._robots.values() for robot in robots}

    async def watch_editor(self) -> None:
        """End this process when that of the editor has ended without a word.

        A process that does not exist from the start is one of another container or machine.
        """
        while self.process_id and _is_running(self.process_id):
            await asyncio.sleep(WATCH)
            if not _is_running(self.process_id):
                self.worker.kill()
                os._exit(0)

    def watch_files(self) -> None:
        """Ask an editor that watches files on request to report those that were changed."""
        workspace = self.client_capabilities.workspace
        known = workspace.did_change_watched_files if workspace is not None else None
        if known is None or not known.dynamic_registration:
            return
        method = lsp.WORKSPACE_DID_CHANGE_WATCHED_FILES
        options = {"watchers": [{"globPattern": WATCHED}]}
        registration = lsp.Registration(method, method, options)
        self.client_register_capability(lsp.RegistrationParams([registration]))

    async def refresh(self) -> None:
        """Read files again, which changed on the disk, and check all open documents."""
        await self.ask("refresh", {})
        self.schedule(self._texts)

    # Checks --------------------------------------------------------------------------------

    def schedule(self, paths: Iterable[str]) -> None:
        """Check documents when no edit has come for a while."""
        self._changed.update(paths)
        if self._check is not None:
            self._check.cancel()
        self._check = asyncio.get_running_loop().create_task(self._check_when_quiet())

    async def _check_when_quiet(self) -> None:
        await asyncio.sleep(self.settings.quiet)
        paths = [path for path in self._changed if path in self._texts]
        if not paths:
            return
        texts = {path: self._texts[path] for path in self._texts}

        def receive(part: Mapping[str, Any]) -> None:
            if all(self._texts.get(path) is text for path, text in texts.items()):
                self._publish(self.publication.receive(part))

        robots = await self.ask("check", {"paths": paths}, receive)
        if robots is None:
            return
        self._changed.difference_update(paths)
        self._robots.update({p: found for p, found in robots.items() if p in self._texts})
        self._publish({*paths, *self.publication.keep(self._list_robots())})

    async def ask(self, method: str, params: Mapping[str, Any], receive: Any = None) -> Any:
        """Ask the checking process, after it has the settings."""
        if self._ready is not None:
            await asyncio.shield(self._ready)
        return await self.worker.ask(method, params, receive)

    def _publish(self, paths: Iterable[str]) -> None:
        for path in paths:
            for uri in self._list_uris(path):
                self.text_document_publish_diagnostics(
                    lsp.PublishDiagnosticsParams(
                        uri, self.list_diagnostics(path), self._get_version(path, uri)
                    )
                )

    def _get_version(self, path: str, uri: str) -> int | None:
        is_open = uri in self._uris.get(path, ())
        return self.workspace.get_text_document(uri).version if is_open else None

    def list_diagnostics(self, path: str) -> list[lsp.Diagnostic]:
        """Return the diagnostics of a file that are known now."""
        found = self.with_uris(self.publication.list_diagnostics(path))
        made: list[lsp.Diagnostic] = self.converter.structure(found, list[lsp.Diagnostic])
        return made

    # Answers -------------------------------------------------------------------------------

    def with_uris(self, value: Any) -> Any:
        """Return an answer of the checking process with addresses in place of paths."""
        if isinstance(value, list):
            return [self.with_uris(one) for one in value]
        if not isinstance(value, dict):
            return value
        return {
            ("uri" if key == "path" else key): (
                self.make_uri(one) if key == "path" else self.with_uris(one)
            )
            for key, one in value.items()
        }

    def make_workspace_edit(self, edits: Mapping[str, list[dict[str, Any]]]) -> lsp.WorkspaceEdit:
        """Return edits by path as an edit of documents, with the versions that are known."""
        made = {
            path: self.converter.structure(some, list[lsp.TextEdit]) for path, some in edits.items()
        }
        workspace = self.client_capabilities.workspace
        client = workspace.workspace_edit if workspace is not None else None
        if client is None or not client.document_changes:
            return lsp.WorkspaceEdit(changes={self.make_uri(p): some for p, some in made.items()})
        changes = [
            lsp.TextDocumentEdit(
                lsp.OptionalVersionedTextDocumentIdentifier(
                    self.make_uri(path), self._get_version(path, self.make_uri(path))
                ),
                some,
            )
            for path, some in made.items()
        ]
        return lsp.WorkspaceEdit(document_changes=list(changes))


def _is_running(process: int) -> bool:
    """Tell whether a process exists; where the system cannot answer without harm, it is False."""
    if os.name != "posix":
        return False
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True
