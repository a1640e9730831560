"""What stops the expansion.

The expansion itself reports these, with the place at which it stopped; the functions are their
pages.
"""

from __future__ import annotations

from ..rule import ERROR, Problem, rule

APPLIES_TO = ()

_NOTHING: tuple[Problem, ...] = ()


@rule(
    ERROR,
    effects={
        "xacro": "stops: the file is not well-formed",
    },
)
def missing_xmlns() -> tuple[Problem, ...]:
    """A file uses ``xacro:`` tags and does not declare the prefix.

    Every file needs ``xmlns:xacro="http://www.ros.org/wiki/xacro"`` on its ``<robot>``, the
    included ones as well: each is parsed on its own. The parser calls it an unbound prefix.
    """
    return _NOTHING


@rule(
    ERROR,
    effects={
        "xacro": "stops: unknown macro name",
    },
)
def unknown_macro() -> tuple[Problem, ...]:
    """A macro is called that is not defined.

    Its name is misspelled, its file is not included, or it is defined further down: xacro works
    from the top to the bottom. Macros of a file included with ``ns`` have that name before theirs.
    """
    return _NOTHING


@rule(
    ERROR,
    effects={
        "xacro": "stops: name is not defined",
    },
)
def undefined_name() -> tuple[Problem, ...]:
    """An expression names something that is not defined.

    What stands in ``${…}`` may name properties defined further up, parameters of the macro, and
    what xacro knows from Python and its ``math``. Arguments are not names: they are ``$(arg …)``.
    """
    return _NOTHING


@rule(
    ERROR,
    effects={
        "xacro": "stops: undefined substitution argument",
    },
)
def undeclared_arg() -> tuple[Problem, ...]:
    """An argument is used that has no value.

    ``$(arg NAME)`` wants ``<xacro:arg name="NAME" default="…"/>`` before it, in this file or in
    one that includes it, or a value on the command line.
    """
    return _NOTHING


@rule(
    ERROR,
    effects={
        "xacro": "stops: no such file",
    },
)
def include_not_found() -> tuple[Problem, ...]:
    """An included file is not there.

    The path is wrong or the file has another name. A relative path is relative to the file with
    the include. With ``optional="true"`` xacro passes over it.
    """
    return _NOTHING


@rule(
    ERROR,
    effects={
        "xacro": "stops: invalid or undefined parameters",
    },
)
def macro_arguments_mismatch() -> tuple[Problem, ...]:
    """A macro is called with other arguments than it takes.

    One without a default is missing, one that it does not have is given, or there are too few or
    too many elements inside the call for its ``*block`` parameters.
    """
    return _NOTHING


@rule(
    ERROR,
    effects={
        "xacro": "stops: circular variable definition",
    },
)
def circular_property() -> tuple[Problem, ...]:
    """Properties are defined by one another in a circle.

    A property is evaluated when it is first used, and its value must not need the property itself.
    ``lazy_eval="false"`` evaluates it where it stands, so that ``x`` may be the old ``x`` plus
    one.
    """
    return _NOTHING


@rule(
    ERROR,
    effects={
        "xacro": "stops at Python's limit of nested calls, or does not end",
    },
)
def endless_expansion() -> tuple[Problem, ...]:
    """The expansion has no end.

    A macro calls itself, a file includes itself, or each call makes several more. xacro goes on
    until Python's stack or the memory is used up; a recursion wants an ``<xacro:if>`` that ends
    it.
    """
    return _NOTHING


@rule(
    ERROR,
    effects={
        "xacro": "stops: conditional evaluated to something that is not a boolean expression",
    },
)
def non_boolean_conditional() -> tuple[Problem, ...]:
    """A condition is neither true nor false.

    ``<xacro:if>`` and ``<xacro:unless>`` take ``true``, ``false``, ``1`` and ``0``, or an
    expression that gives one. A comparison is such an expression only inside ``${…}``: ``$(arg
    kind) == arm`` is text.
    """
    return _NOTHING


@rule(
    ERROR,
    effects={
        "xacro": "stops",
    },
)
def expansion_failed() -> tuple[Problem, ...]:
    """The expansion stopped for another reason.

    An expression that Python refuses, a YAML file that is not YAML, a tag without an attribute it
    needs, a substitution that there is not. The message is xacro's, with the place.
    """
    return _NOTHING
