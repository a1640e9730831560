"""Calls with limits: what ends them, in a fork and in a new interpreter."""

import os
import sys
import time

import pytest

from urdftool import limited
from urdftool.errors import ModelError
from urdftool.isolated import ProcessDied
from urdftool.limited import LimitExceeded, Limits, call_with_limits, open_no_files
from urdftool.source.location import Place, SourceFile

LIMITS = Limits(time=60.0, processor=1.0, memory=200 << 20)
CAN_FORK = limited._can_fork
LINUX = pytest.mark.skipif(sys.platform != "linux", reason="other systems have fewer limits")


@pytest.fixture(params=["fork", "interpreter"], autouse=True)
def kind(request, monkeypatch):
    """Call in a fork, if the system has it, and in a new interpreter."""
    if request.param == "fork" and sys.platform != "linux":
        pytest.skip("no fork")
    monkeypatch.setattr(limited, "_can_fork", lambda _: request.param == "fork")


def double(number):
    return 2 * number


def fail(file):
    raise ModelError("no legs", at=Place(file, 4, 8))


def give(file, other):
    return [file, other, Place(file, 1, 2)]


def work(_):
    while True:
        pass


def fill(_):
    return bytearray(1 << 30)


def wait(_):
    time.sleep(600)


def leave(_):
    os._exit(0)


def talk(_):
    os.write(1, b"out")
    os.write(2, b"err")


def divide(_):
    return 1 / 0


def read_twice(_):
    found = []
    with open_no_files():
        try:
            open(__file__).close()
        except OSError:
            found.append("none")
    with open(__file__) as stream:
        found.append("read" if stream.readline() else "")
    return found


def test_a_result_is_returned():
    assert call_with_limits(double, 21, limits=LIMITS) == 42


def test_arguments_in_a_result_are_the_same_objects():
    file, other = SourceFile("r.urdf", b"<robot/>"), SourceFile("s.urdf", b"")
    found = call_with_limits(give, file, other, limits=LIMITS)
    assert found[0] is file
    assert found[1] is other
    assert found[2].file is file


def test_an_error_has_its_place():
    file = SourceFile("r.urdf", b"<robot>\n</robot>")
    with pytest.raises(ModelError, match="no legs") as error:
        call_with_limits(fail, file, limits=LIMITS)
    assert error.value.at.file is file
    with pytest.raises(ZeroDivisionError):
        call_with_limits(divide, 0, limits=LIMITS)


@LINUX
def test_processor_time_is_limited():
    with pytest.raises(LimitExceeded, match="1 s of processor time"):
        call_with_limits(work, 0, limits=LIMITS)


@LINUX
def test_memory_is_limited():
    with pytest.raises(LimitExceeded, match="200 MiB of memory"):
        call_with_limits(fill, 0, limits=LIMITS)
    assert len(call_with_limits(fill, 0, limits=Limits(60.0))) == 1 << 30


def test_time_is_limited():
    with pytest.raises(LimitExceeded, match=r"0\.2 s"):
        call_with_limits(wait, 0, limits=Limits(0.2))


def test_a_process_without_a_result_died():
    with pytest.raises(ProcessDied, match="exit code 0"):
        call_with_limits(leave, 0, limits=LIMITS)


def test_what_a_library_prints_is_not_printed(capfd):
    assert call_with_limits(talk, 0, limits=LIMITS) is None
    assert capfd.readouterr() == ("", "")


@LINUX
def test_no_file_can_be_opened():
    assert call_with_limits(read_twice, 0, limits=LIMITS) == ["none", "read"]


def test_no_fork_uses_a_library_whose_threads_it_lacks(monkeypatch):
    monkeypatch.setattr(limited, "can_fork", lambda: True)
    monkeypatch.setitem(sys.modules, "threaded", sys)
    assert CAN_FORK("")
    assert CAN_FORK("absent")
    assert not CAN_FORK("threaded")
