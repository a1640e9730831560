"""Entry point of ``python -m urdftool``."""

from .cli import run

run()
