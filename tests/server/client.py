"""A small client of the Language Server Protocol over pipes; it waits for what must arrive."""

import json
import queue
import subprocess
import sys
import threading

WAIT = 120  # s; no test is faster or slower by it: it only ends one that would never end


class Client:
    """An editor without a screen."""

    def __init__(
        self, folder, *options, encoding="utf-16", capabilities=None, env=None, process=None
    ):
        self.process = subprocess.Popen(
            [sys.executable, "-m", "urdftool", "server", *options],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env=env,
        )
        self.arrived = queue.Queue()
        self.notes = []
        self.diagnostics = {}
        self.versions = {}
        self.number = 0
        self.texts = {}
        threading.Thread(target=self._read, daemon=True).start()
        threading.Thread(target=self.process.stderr.read, daemon=True).start()
        general = {"positionEncodings": [encoding]}
        answer = self.ask(
            "initialize",
            processId=process,
            rootUri=folder.as_uri(),
            workspaceFolders=[{"uri": folder.as_uri(), "name": "robots"}],
            capabilities={"general": general, **(capabilities or {})},
        )
        self.capabilities = answer["capabilities"]
        self.notify("initialized")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.ask("shutdown")
            self.notify("exit")
            self.process.wait(WAIT)
        self.process.stdin.close()

    def _read(self):
        stream = self.process.stdout
        while True:
            length = 0
            while (line := stream.readline()).strip():
                name, _, value = line.partition(b":")
                if name.lower() == b"content-length":
                    length = int(value)
            if not length:
                self.arrived.put(None)
                return
            self.arrived.put(json.loads(stream.read(length)))

    def _send(self, **message):
        data = json.dumps({"jsonrpc": "2.0", **message}).encode()
        self.process.stdin.write(b"Content-Length: %d\r\n\r\n%s" % (len(data), data))
        self.process.stdin.flush()

    def notify(self, method, **params):
        self._send(method=method, params=params)

    def ask(self, method, **params):
        """Return the answer of a request."""
        answer = self.request(method, **params)
        assert "error" not in answer, answer
        return answer["result"]

    def request(self, method, **params):
        """Return the whole message that answers a request, which may be an error."""
        self.number += 1
        number = self.number
        self._send(id=number, method=method, params=params)
        found = []

        def answered(message):
            if message.get("id") == number and "method" not in message:
                found.append(message)
            return bool(found)

        self.wait(answered)
        return found[0]

    def wait(self, until):
        """Handle messages until one fulfils a condition."""
        while True:
            message = self.arrived.get(timeout=WAIT)
            assert message is not None, "the server ended"
            if message.get("method") == "textDocument/publishDiagnostics":
                params = message["params"]
                self.diagnostics[params["uri"]] = params["diagnostics"]
                self.versions[params["uri"]] = params.get("version")
            elif message.get("method") == "window/logMessage":
                self.notes.append(message["params"]["message"])
            elif "method" in message and "id" in message:
                self._send(id=message["id"], result=None)
            if until(message):
                return

    def open(self, path, text=None):
        text = path.read_bytes().decode() if text is None else text
        self.texts[path] = text, 1
        document = {"uri": path.as_uri(), "languageId": "xml", "version": 1, "text": text}
        self.notify("textDocument/didOpen", textDocument=document)

    def change(self, path, *changes, text=None):
        _, version = self.texts[path]
        self.texts[path] = text, version + 1
        document = {"uri": path.as_uri(), "version": version + 1}
        events = list(changes) or [{"text": text}]
        self.notify("textDocument/didChange", textDocument=document, contentChanges=events)

    def settle(self, path):
        """Return the diagnostics of the present version of a document."""
        _, version = self.texts[path]
        uri = path.as_uri()
        if self.versions.get(uri) != version:
            self.wait(lambda _: self.versions.get(uri) == version)
        return self.diagnostics[uri]

    def wait_until(self, condition):
        """Handle messages until a condition holds."""
        if not condition():
            self.wait(lambda _: condition())

    def list_found(self, path, code):
        """Return the shown diagnostics of a rule."""
        return [one for one in self.diagnostics.get(path.as_uri(), ()) if one["code"] == code]

    def wait_for(self, path, code):
        """Handle messages until a rule is shown in a file."""
        self.wait_until(lambda: self.list_found(path, code))

    def ask_at(self, method, path, line, character, **more):
        return self.ask(
            method,
            textDocument={"uri": path.as_uri()},
            position={"line": line, "character": character},
            **more,
        )
