import http.client
import re
import socket

import pytest

from urdftool.errors import AddressError
from urdftool.viewer import server

from .serving import free_port

pytest.importorskip("viser")


TOKEN = "AZ09_-az" * 4  # fixed, since it is in the names of tests


@pytest.fixture(scope="module")
def page():
    """The port of a server that shows nothing."""
    port = free_port()
    running = server.start("127.0.0.1", port, TOKEN, lambda: "</title><b>robot</b>")
    yield port
    running.stop()


def ask(port, *lines):
    """Send a request line by line; gives the status and the answer."""
    with socket.create_connection(("127.0.0.1", port), timeout=10) as link:
        link.sendall("\r\n".join([*lines, "Connection: close", "", ""]).encode())
        answer = b""
        while piece := link.recv(65536):
            answer += piece
    return int(answer.split(b" ")[1]), answer


def get(port, path=f"/{TOKEN}/", **headers):
    link = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
    link.request("GET", path, headers={name.replace("_", "-"): v for name, v in headers.items()})
    answer = link.getresponse()
    return answer.status, dict(answer.getheaders()), answer.read().decode("utf-8", "replace")


def read_policy(port):
    """Return the sources of each directive."""
    policy = get(port)[1]["Content-Security-Policy"]
    return {words[0]: words[1:] for words in map(str.split, policy.split("; "))}


def test_the_page_has_our_title_and_may_fetch_nothing(page):
    status, headers, text = get(page)
    assert status == 200
    assert "<title>&lt;/title&gt;&lt;b&gt;robot&lt;/b&gt;</title>" in text
    policy = read_policy(page)
    assert policy["default-src"] == ["'none'"]
    assert policy["connect-src"] == ["data:", "blob:", f"ws://127.0.0.1:{page}"]
    assert headers["Referrer-Policy"] == "no-referrer"
    assert headers["Cache-Control"] == "no-store"


def test_only_scripts_and_styles_of_the_page_run(page):
    policy = read_policy(page)
    (nonce,) = policy["style-src"]
    assert policy["script-src"] == [nonce, "'wasm-unsafe-eval'"]
    words = {word for sources in policy.values() for word in sources}
    assert not words & {"'unsafe-inline'", "'unsafe-eval'", "*", "'self'", "http:", "https:"}
    _, headers, text = get(page)
    nonce = headers["Content-Security-Policy"].split("'nonce-")[1].split("'")[0]
    tags = re.findall(r"<(?:script|style)\b[^>]{0,200}", text)
    assert len(tags) == 3
    assert all(f'nonce="{nonce}"' in tag for tag in tags)
    assert nonce not in get(page)[2]  # each answer has its own
    assert "style=" not in re.sub(r"<script.*?</script>", "", text, flags=re.DOTALL)


def test_the_page_names_no_address_of_the_network(page):
    """What the library carries in its page; the rest is packed, and looked at in a browser."""
    _, _, text = get(page)
    assert "fonts.googleapis" not in text
    assert '<link rel="stylesheet"' not in text
    assert 'src="http' not in text


@pytest.mark.parametrize(
    "path",
    ["/", "", f"/{TOKEN[:-1]}/", f"/{TOKEN}x/", f"/{TOKEN.swapcase()}/", f"//{TOKEN}/",
     "/index.html", f"/?token={TOKEN}", "/assets/x.js", f"/x/{TOKEN}/", "/%00/", "/\xff/"],
)  # fmt: skip
def test_nothing_is_served_without_the_token(page, path):
    path = path or "/"
    status, answer = ask(page, f"GET {path} HTTP/1.1", f"Host: 127.0.0.1:{page}")
    assert status in (400, 403)
    assert b"<script" not in answer
    assert upgrade(page, path.replace("\xff", "y")) == 403


def test_tokens_differ():
    tokens = {server.make_token() for _ in range(100)}
    assert len(tokens) == 100
    assert all(re.fullmatch(r"[\w-]{20,}", token) for token in tokens)


def upgrade(port, path=f"/{TOKEN}", **headers):
    return get(
        port, path, Upgrade="websocket", Connection="Upgrade", Sec_WebSocket_Version="13",
        Sec_WebSocket_Key="AAAAAAAAAAAAAAAAAAAAAA==", **headers,
    )[0]  # fmt: skip


def test_another_site_may_not_talk_to_it(page):
    assert upgrade(page, Origin="http://evil.example") == 403
    assert upgrade(page, Origin=f"http://127.0.0.1:{page + 1}") == 403
    assert upgrade(page, Origin="null") == 403
    assert get(page, Origin="http://evil.example")[0] == 403


def test_a_name_that_leads_here_is_not_enough(page):
    assert get(page, Host=f"evil.example:{page}")[0] == 403
    assert get(page, Host=f"localhost:{page}")[0] == 200


@pytest.mark.parametrize(
    "lines",
    [
        ["Host: {here}", "Host: {here}"],
        ["Host: {here}", "Host: evil.example"],
        [],
        ["Host: {here}", "Origin: http://{here}", "Origin: http://evil.example"],
        ["Host: {here}", "Origin: http://{here}", "Origin: http://{here}"],
        ["Host: {here}", "Upgrade: websocket", "Upgrade: h2c"],
        ["Host: [::1"],
        ["Host: {here}", "Origin: http://[::1"],
    ],
)
@pytest.mark.parametrize("path", ["/", f"/{TOKEN}/"])
def test_repeated_and_malformed_headers_are_bad_requests(page, path, lines):
    here = f"127.0.0.1:{page}"
    status, answer = ask(page, f"GET {path} HTTP/1.1", *(line.format(here=here) for line in lines))
    assert status == 400, answer


PATHS = (
    *("/../../../../etc/passwd", "/..%2f..%2f..%2f..%2fetc/passwd", "/%2e%2e/%2e%2e/etc/passwd"),
    *("//etc/passwd", "/etc/passwd", "/assets/../../../../../etc/passwd", "/..\\..\\etc\\passwd"),
    *(
        "/%252e%252e/etc/passwd",
        "/file:///etc/passwd",
        "/.%00./etc/passwd",
        "/assets/%2e%2e/server.py",
    ),
)


@pytest.mark.parametrize("start", ["", f"/{TOKEN}", f"/{TOKEN}/"])
@pytest.mark.parametrize("path", PATHS)
def test_no_path_leads_out_of_the_page(page, path, start):
    status, answer = ask(page, f"GET {start}{path} HTTP/1.1", f"Host: 127.0.0.1:{page}")
    assert b"root:" not in answer
    assert status in (400, 403, 404), answer[:80]
    assert len(answer) < 1000


def test_its_own_page_may_talk_to_it(page):
    import viser
    from websockets.sync.client import connect

    with connect(
        f"ws://127.0.0.1:{page}/{TOKEN}",
        subprotocols=[f"viser-v{viser.__version__}"],
        origin=f"http://127.0.0.1:{page}",
    ) as socket_:
        assert socket_.recv(timeout=10)


def test_it_listens_on_the_loopback_alone(page):
    with socket.socket() as other:
        other.bind(("127.0.0.2", page))  # taken if it listened everywhere


def test_it_opens_no_tunnel(page, monkeypatch):
    import viser._viser as library

    monkeypatch.setattr(library, "ViserTunnel", lambda *_: pytest.fail("a tunnel was opened"))
    running = server.start("127.0.0.1", free_port(), TOKEN, lambda: "t")
    try:
        assert running.request_share_url() is None
    finally:
        running.stop()


def test_a_page_that_cannot_be_guarded_is_not_served(monkeypatch):
    monkeypatch.setattr(
        server, "_handle_request", lambda host, token, title, answer, *request: answer(*request)
    )
    port = free_port()
    with pytest.raises(AddressError, match="without the token"):
        server.start("127.0.0.1", port, TOKEN, lambda: "t")
    assert server.is_free("127.0.0.1", port)


@pytest.fixture
def taken():
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        listener.listen()
        yield listener.getsockname()[1]


def test_a_taken_port_that_was_asked_for_is_refused(taken):
    with pytest.raises(AddressError, match=f"port {taken} of 127.0.0.1 is in use"):
        server.choose_port("127.0.0.1", taken)


def test_the_next_free_port_is_found(taken, monkeypatch):
    monkeypatch.setattr(server, "PORT", taken)
    assert taken < server.choose_port("127.0.0.1", None) < taken + server.TRIED


def test_no_address_of_this_computer():
    with pytest.raises(AddressError, match="not an address of this computer"):
        server.choose_port("192.0.2.1", 8733)


@pytest.mark.parametrize(
    ("host", "loopback"),
    [
        ("127.0.0.1", True), ("127.1.2.3", True), ("localhost", True), ("::1", True),
        ("[::1]", True), ("0.0.0.0", False), ("192.168.1.4", False), ("robot.local", False),
        ("", False), ("127.0.0.1.evil.example", False),
    ],
)  # fmt: skip
def test_what_is_the_loopback(host, loopback):
    assert server.is_loopback(host) is loopback


def test_addresses():
    assert server.make_url("127.0.0.1", 8733, "t") == "http://127.0.0.1:8733/t/"
    assert server.make_url("::1", 8733, "t") == "http://[::1]:8733/t/"


@pytest.mark.parametrize("asked", ["a b", "x; script-src *", "", "x, y", "x'y", "x*"])
def test_a_hostile_host_says_nothing_in_the_policy(asked):
    policy = server.make_policy(asked, "n")
    assert policy.count(";") == server.make_policy("localhost:1", "n").count(";")
    assert "connect-src data: blob: ws://;" in policy
