"""Check of a description by the rules."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from ..collector import pause_collector
from ..configuration import Configuration, find_configuration
from ..diagnostic import Severity
from ..errors import LimitError, ModelError, SourceError, UrdftoolError, XmlError
from ..extras import find_missing_library
from ..finding import Cause, Finding, Group
from ..model.attached import TooManyAttached
from ..model.elements import Robot
from ..model.read import read_robot
from ..rules import applies_to
from ..rules.mesh.mesh_uses import collect_unread_meshes
from ..rules.old_names import find_old_names, find_old_rules
from ..rules.rule import Problem, Rule
from ..rules.table import APPLIES_TO, FIXES
from ..rules.unread_files import collect_unread_files
from ..source.description import Description, is_xacro
from ..source.document import Document, parse_once, read_file
from ..source.location import SourceFile
from ..source.packages import Packages
from ..source.unknown_arguments import list_unknown_arguments
from .completed_files import find_completing_code, find_supplying_code
from .drake_directives import find_welded_links
from .effect_kinds import find_kinds, find_kinds_of_error
from .imported_readers import find_imported_readers
from .libraries import TESSERACT
from .meant import is_explained, is_input_of_test
from .merge import merge, sort_findings
from .moot import Rejections
from .motion import (
    UNUSED_JOINT,
    is_joint_unused,
    is_link_unused,
    is_of_scenery,
    is_welded_in_mujoco,
    replace_mujoco,
)
from .not_checked import (
    convert_error,
    group_by_missing_folder,
    refuse_other_files,
    refuse_other_roots,
    refuse_srdf,
)
from .options import Options
from .other_readers import (
    drop_other_effects,
    is_for_other_readers,
    is_of_dynamics,
    is_of_unmoved_robot,
    is_used,
    lower_severity,
)
from .outcome import NOT_EXPANDED, Report
from .placeholders import find_template_error, refuse_template
from .questions import join_variants, list_questions
from .reading import make_packages, make_unexpanded, read_in_other_format, read_mended, read_urdf
from .settings import Settings, read_settings
from .suppress import read_suppressions, report_unused, suppress
from .targets import infer_targets
from .unread_models import name_version
from .variants import label


def check_robot(robot: Robot, options: Options) -> Report:
    """Check a robot that was read from a description, which is its ``source``.

    Raises:
        ConfigError: The configuration is invalid.
    """
    assert robot.source is not None
    configuration = find_configuration(robot.source.path, options.config)
    settings = read_settings(robot.source.path, configuration, options.settings)
    report = Report(robot.source.path)
    source = robot.source.without_cache()
    _check_description(source, replace(robot, source=source), settings, report, [], options)
    return report


def warn_of_renamed(selectors: Iterable[str], path: str | Path, config: str | None) -> None:
    """Warn callers of the Python API of old names of rules and thresholds.

    Raises:
        ConfigError: The configuration cannot be read.
    """
    table = find_configuration(path, config).lint
    for old in dict.fromkeys([*find_old_rules(selectors), *find_old_names(table)]):
        warnings.warn(old.message, DeprecationWarning, stacklevel=3)


def check_file(path: str | Path, options: Options) -> Report:
    """Check one description; all its defects are in the report.

    Raises:
        ConfigError: The configuration is invalid.
    """
    with pause_collector():
        return join_variants(
            [_check_with_cache(*question) for question in list_questions(path, options)]
        )


_URDF_ENDINGS = (".urdf", ".xacro")
"""Endings of files that are read as URDF regardless of their content."""


def _check_with_cache(
    path: str | Path, options: Options, configuration: Configuration, settings: Settings
) -> tuple[str, Report]:
    """Return the label of the xacro arguments and the report, which is cached if possible."""
    question = path, options, configuration, settings
    if options.cache is None or str(path) == "-":
        return label(options.arguments), _check_variant(*question)
    view = options.workspace.with_record()
    report = _check_variant(path, replace(options, workspace=view), configuration, settings)
    assert view.dependencies is not None
    if report.format != "urdf":  # MuJoCo reads files itself
        return label(options.arguments), report
    key = options.get_key(options.cache, path, configuration, settings)
    options.cache.write(key, report, view.dependencies)
    return label(options.arguments), report


def _check_variant(
    path: str | Path, options: Options, configuration: Configuration, settings: Settings
) -> Report:
    """Check a description with one set of xacro arguments."""
    report = Report(str(path))
    failures: list[UrdftoolError] = []
    description: Description | None = None
    try:
        file = read_file(path, options.workspace)
        refuse_other_files(file)
        if options.read_other is not None and not file.path.endswith(_URDF_ENDINGS):
            try:
                other = read_in_other_format(file, options, configuration)
            except LimitError:
                raise
            except (SourceError, ModelError) as error:
                completed_by = find_completing_code(options.workspace, file.path, error)
                if completed_by:
                    report.stopped, report.completed_by = error.message, completed_by
                    return report
                if isinstance(error, XmlError):
                    return _stop(report, find_template_error(error), "not-well-formed")
                report = _stop(report, find_template_error(error), "unreadable-model")
                group = group_by_missing_folder(options.workspace, error)
                if group is not None:
                    report.findings = [replace(f, group=group) for f in report.findings]
                if isinstance(error, ModelError):
                    packages = make_packages(file, options, configuration)
                    one = make_unexpanded(file, [], packages)
                    report.findings = [name_version(f, one) for f in report.findings]
                return report
            if other is not None:
                assert other.source is not None
                report.unread = other.unread
                _check_description(other.source, other, settings, report, [], options)
                return report
        if not options.expand and is_xacro(file):
            packages = make_packages(file, options, configuration)
            return _check_source(file, packages, settings, report, options)
        try:
            description = read_urdf(file, options, configuration)
        except SourceError as error:
            failures.append(error)
            description = read_mended(file, options, configuration)
        if description is not None:
            report.unknown_arguments = list_unknown_arguments(
                options.arguments, description.expansion
            )
            root = description.document.root
            if description.expansion and not (root.find_child("link") or root.find_child("joint")):
                from .skipped import explain_no_links

                report.skipped = explain_no_links(description)
                return report
            refuse_srdf(description)
            try:
                refuse_template(description.document)
            except SourceError as error:
                return _stop(report, error, "not-a-number")
    except UrdftoolError as error:
        report.error = error
        return report
    robot = None
    if description is not None:
        try:
            refuse_other_roots(description)
            robot = read_robot(description.document.root)
            robot.source = description
        except SourceError as error:
            failures.insert(0, error)
            settings = replace(settings, select=(), extend_select=())
    if robot is None or description is None:
        report.stopped = failures[0].message
        packages = make_packages(file, options, configuration)
        description = make_unexpanded(file, failures, packages)
    _check_description(description, robot, settings, report, failures, options)
    return report


def _stop(report: Report, error: UrdftoolError, rule: str) -> Report:
    """Return the report of a robot that was not checked, with the error as its finding."""
    report.stopped = error.message
    report.findings = [convert_error(error, {}, unchecked=True, rule=rule)]
    return report


def _check_source(
    file: SourceFile, packages: Packages, settings: Settings, report: Report, options: Options
) -> Report:
    """Check a xacro file as it is written, without the files that it includes."""
    from ..source.xacro_parse import parse_xacro

    failures: list[UrdftoolError] = []
    try:
        parse_xacro(file)
        report.skipped = NOT_EXPANDED
    except SourceError as error:
        failures.append(error)
        report.stopped = error.message
    description = make_unexpanded(file, failures, packages)
    _check_description(description, None, settings, report, failures, options)
    return report


def _check_description(
    description: Description,
    robot: Robot | None,
    settings: Settings,
    report: Report,
    failures: list[UrdftoolError],
    options: Options,
) -> None:
    guessed: frozenset[str] = frozenset()
    if settings.targets is not None:
        targets = settings.targets
    elif robot is not None:
        inference = infer_targets(robot, description)
        targets, report.overruled = inference.targets, inference.overruled
        guessed = frozenset(guess.target for guess in inference.guesses)
    else:
        targets = frozenset()
    report.targets = targets
    report.files = tuple(file.path for file in description.files)
    report.format = "urdf" if robot is None else robot.format
    if robot is not None and not settings.get_names():
        report.skipped = "its configuration leaves no rule"
    chosen = settings.targets is not None  # then the user named the readers
    used = None if chosen else find_imported_readers(description, targets)
    has_srdf = used is not None and TESSERACT in used.readers
    for_rules = targets | {"moveit"} if has_srdf else targets
    rules = _select_rules(settings, for_rules, description, report.format)
    if report.format != "urdf":
        rules = [rule for rule in rules if report.format in rule.formats]
    documents = list(_list_documents(description, report.format))
    findings = [
        convert_error(failure, settings.severity, unchecked=robot is None) for failure in failures
    ]
    if used is not None and robot is not None:  # readers may accept what is not well-formed
        findings = [lower_severity(f, used, find_kinds_of_error(f)) for f in findings]
    observer = options.observer
    if observer is not None:
        observer.receive_description(description, robot, list(findings))
    subjects: dict[str, Any] = {
        "robot": robot,
        "description": description,
        "targets": targets,
        "guessed": guessed,
    }
    is_of_drake = used is not None and "drake" in used.readers
    welded = find_welded_links(options.workspace, description.path) if is_of_drake else frozenset()
    ran: set[str] = set()
    origins: dict[int, Any] = {}
    hidden: list[Finding] = []
    rejections = Rejections(robot if report.format == "urdf" else None)
    for rule in rules:
        if "robot" in rule.needs and robot is None:
            continue
        if observer is not None:
            observer.check_progress()
        ran.add(rule.name)
        for document in documents if "document" in rule.needs else [None]:
            subjects["document"] = document
            problems = _run_rule(rule, subjects, settings, report)
            for problem in problems:
                finding = _convert_finding(rule, problem, settings, targets, robot)
                if finding is None:
                    continue
                kinds = find_kinds(rule.name, rule.select_keys(problem.effects), finding.effects)
                rejections.add(rule.name, kinds)  # also of one that is off
                if used is not None and settings.severity.get(rule.name) is None:
                    finding = lower_severity(finding, used, kinds)
                finding = _pass_over_supplied(finding, description, settings, options)
                if not settings.is_pedantic_on(rule.name):
                    is_off = (
                        problem.pedantic
                        or (
                            welded
                            and is_of_dynamics(rule)
                            and is_link_unused(robot, problem, welded)
                        )
                        or _is_info_off(rule, finding, settings)
                        or is_of_unmoved_robot(rule, finding, robot)
                        or is_of_scenery(rule, finding, robot)
                        or is_input_of_test(rule, finding)
                        or (finding.severity is not Severity.ERROR and is_explained(problem))
                    )
                    report.minor += bool(is_off)
                    if not is_off and used and is_for_other_readers(rule, finding, used, kinds):
                        count = report.for_other_readers.get(rule.name, 0)
                        report.for_other_readers[rule.name] = count + 1
                        report.about_dynamics += not used.moving and is_of_dynamics(rule)
                        is_off = True
                    if is_off:
                        hidden.append(finding)
                        continue
                    finding = drop_other_effects(finding, used)
                findings.append(finding)
                if options.fixes and report.format == "urdf" and rule.name in FIXES:
                    origins[id(finding)] = problem, subjects["document"]
    suppressions, wrong = read_suppressions(documents)
    if suppressions or wrong:
        findings, report.ignored = suppress(findings, suppressions)
        suppress(hidden, suppressions)  # their comments have a use
        selected = set(settings.get_names())
        tags = set(description.document.elements_by_tag)
        idle = {name for name in selected if not applies_to(name, tags)}
        stale = report_unused(suppressions, ran | idle) if robot is not None else ()
        findings += [f for f in (*wrong, *stale) if f.code in selected]
    fixes = options.fixes and report.format == "urdf"
    if fixes and any(f.code in FIXES for f in findings):
        from .fix import Origin, add_fixes

        made = {number: Origin(*origin) for number, origin in origins.items()}
        add_fixes(report, findings, made, robot, description, options)
    findings = [
        rejections.remove_moot_effects(one, selected=bool(settings.select)) for one in findings
    ]
    if used is not None:  # their readers reject the robot for other defects, which come first
        findings = [one for one in findings if not one.moot or one.severity is Severity.ERROR]
    report.findings = sort_findings(merge(findings))
    rejected = rejections.list_rejecting({finding.code for finding in findings})
    report.rejected = {
        r: rules for r, rules in rejected.items() if used is None or is_used(r, used)
    }
    report.readers = frozenset() if used is None else used.readers
    report.unread_meshes = {} if robot is None else collect_unread_meshes(robot)
    report.unread_files = {} if robot is None else collect_unread_files(robot)
    for memo in (description.memo, *([robot.memo] if robot is not None else ())):
        memo.clear()  # breaks a reference cycle with the robot


def _pass_over_supplied(
    finding: Finding, description: Description, settings: Settings, options: Options
) -> Finding:
    """Return an info in place of an error about meshes that code of the project supplies."""
    is_error = finding.code == "mesh-not-found" and finding.severity is Severity.ERROR
    if not is_error or settings.severity.get(finding.code) is not None or description.path == "-":
        return finding
    found = find_supplying_code(options.workspace, description.path, finding.data)
    if not found:
        return finding
    return replace(finding, severity=Severity.INFO, effects={}, hint=found)


def _is_info_off(rule: Rule, finding: Finding, settings: Settings) -> bool:
    """Tell whether a finding is an info of a rule whose infos are off, and not so configured."""
    is_info = finding.severity is Severity.INFO
    return is_info and not rule.infos and settings.severity.get(rule.name) is None


_TELLING = frozenset(tag for tags in APPLIES_TO.values() for tag in tags)


def _select_rules(
    settings: Settings, targets: frozenset[str], description: Description, name: str
) -> list[Rule]:
    """Return the rules to run, computed once for descriptions with equal tags and targets."""
    known = description.document.elements_by_tag.keys() & _TELLING
    tags = frozenset(known) if name == "urdf" else _TELLING  # others have other tags
    return settings.memo.get((targets, tags), lambda: settings.get_rules(targets, tags))


def _list_documents(description: Description, name: str) -> Iterator[Document]:
    """Yield the source files, unexpanded, without those that are not well-formed."""
    if name == "urdf" and description.expansion is None and description.document.root.tag:
        yield description.document
        return
    for file in description.files:
        try:
            yield parse_once(file)
        except SourceError:
            continue


def _run_rule(
    rule: Rule, subjects: Mapping[str, Any], settings: Settings, report: Report
) -> list[Problem]:
    """Return the problems that a rule finds; an exception is recorded as a bug of urdftool."""
    found: list[Problem] = []
    try:
        arguments = [subjects[name] for name in rule.needs]
        found.extend(rule.check(*arguments, **settings.thresholds.get(rule.name, {})))
        unknown = {key for problem in found for key in problem.effects or ()} - rule.effects.keys()
        if unknown:
            raise LookupError(f"no effect on {sorted(unknown)}")
        if not rule.pedantic and any(problem.pedantic for problem in found):
            raise LookupError("the rule names no pedantic case")
    except TooManyAttached:  # analysis-incomplete reports it
        subjects["robot"].memo.get(TooManyAttached, list).append(rule.name)
    except Exception as error:
        library = find_missing_library(error)
        if library is None:
            report.failed_rules[rule.name] = f"{type(error).__name__}: {error}"
        else:
            report.skipped_rules[rule.name] = library
    return found


def _convert_finding(
    rule: Rule,
    problem: Problem,
    settings: Settings,
    targets: frozenset[str],
    robot: Robot | None,
) -> Finding | None:
    """Convert a problem to a finding; None for a defect in motion of a link fixed to the world."""
    severity = settings.severity.get(rule.name)
    effects, hint = rule.select_effects(problem.effects), problem.hint
    if robot is not None and robot.format != "urdf":
        effects, hint = {}, ""  # they are about URDF
    if severity is None:
        severity = problem.severity or rule.get_severity(targets)
        if rule.of_motion and severity is not Severity.ERROR:
            if is_link_unused(robot, problem):
                return None
            if is_joint_unused(robot, problem):
                severity, effects = Severity.INFO, {"every reader": UNUSED_JOINT}
            elif is_welded_in_mujoco(robot, problem):
                effects = replace_mujoco(effects)
    causes = rule.caused_by if problem.caused_by is None else problem.caused_by
    concerned = targets if rule.on is None else targets.intersection(rule.on)
    return Finding(
        rule.name,
        severity,
        problem.message,
        problem.place,
        problem.kind,
        problem.name,
        tuple(sorted(concerned)) if rule.on is not None else (),
        effects,
        hint,
        site=problem.site,
        group=Group(rule.group, problem.group, problem.alike) if rule.group else None,
        cause=Cause(causes, problem.cause_sites) if causes else None,
        owner=problem.owner,
        data=problem.data,
    )
