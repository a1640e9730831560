"""What a child process is made to do in tests."""

import os
import signal
import time

from urdftool.errors import ModelError


def double(number):
    return 2 * number


def talk():
    os.write(1, b"noise on stdout\n")
    os.write(2, b"noise on stderr\n")
    return "said"


def report(number, emit):
    emit(number)
    emit(number + 1)
    return number + 2


def die_telling(emit):
    emit("on my way")
    crash()


def fail():
    return 1 / 0


def refuse():
    raise ModelError("no legs")


def crash():
    os.kill(os.getpid(), signal.SIGSEGV)


def spin():
    while True:
        pass


def wait(seconds):
    time.sleep(seconds)
    return "waited"


def hang():
    time.sleep(60)
