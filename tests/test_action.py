"""The GitHub Action: its steps run by bash as the runner runs them, in a scratch checkout."""

import json
import os
import re
import shutil
import subprocess
import sys
from importlib.resources import files
from pathlib import Path

import jsonschema
import pytest
import yaml
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from tests.conftest import ROOT

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ACTION = yaml.safe_load((ROOT / "action.yml").read_text("utf-8"))
INSTALL, LINT = ACTION["runs"]["steps"]
BASH = shutil.which("bash")
GOOD = '<robot name="r"><link name="a"/></robot>\n'
BAD = '<robot><link name="a"/></robot>\n'

pytestmark = pytest.mark.skipif(BASH is None, reason="bash is not there")


def test_it_is_as_github_has_it():
    schema = json.loads(
        (files("check_jsonschema") / "builtin_schemas/vendor/github-actions.json").read_text()
    )
    validator = jsonschema.validators.validator_for(schema)(schema)
    assert [error.message for error in validator.iter_errors(ACTION)] == []


def test_no_input_stands_in_a_script():
    """What is put into a script by the runner is read by bash as part of it."""
    for step in ACTION["runs"]["steps"]:
        assert "${{" not in step["run"]
    used = re.findall(r"inputs\.([\w-]+)", json.dumps(ACTION["runs"]))
    assert sorted(used) == sorted(ACTION["inputs"])


class Runner:
    """What GitHub's runner does with a step of a composite action."""

    def __init__(self, folder):
        self.temp = folder / "temp"
        self.output = folder / "output"
        self.temp.mkdir()
        self.output.touch()

    def run(self, step, **inputs):
        given = {name: spec.get("default", "") for name, spec in ACTION["inputs"].items()}
        given |= {name.replace("_", "-"): value for name, value in inputs.items()}
        context = {f"inputs.{name}": value for name, value in given.items()}
        context["github.action_path"] = str(ROOT)
        env = {
            name: re.sub(r"\$\{\{ ([\w.-]+) \}\}", lambda m: context[m[1]], value)
            for name, value in step["env"].items()
        }
        script = self.temp / "script.sh"
        script.write_text(step["run"])
        return subprocess.run(
            [BASH, "--noprofile", "--norc", "-eo", "pipefail", script],
            env={
                **os.environ,
                **env,
                "RUNNER_TEMP": str(self.temp),
                "GITHUB_OUTPUT": str(self.output),
            },
            capture_output=True,
            text=True,
            check=False,
        )

    def outputs(self):
        return self.output.read_text()


@pytest.fixture
def runner(tmp_path_factory):
    """With urdftool installed where the first step puts it."""
    made = Runner(tmp_path_factory.mktemp("runner"))
    bin = made.temp / "urdftool" / "bin"
    bin.mkdir(parents=True)
    (bin / "urdftool").symlink_to(Path(sys.executable).parent / "urdftool")
    return made


def test_findings_are_annotations_and_fail_the_step(runner, write):
    write("src/bad.urdf", BAD)
    write("src/good robot.urdf", GOOD)
    done = runner.run(LINT)
    assert done.returncode == 1, done.stderr
    assert "::error file=src/bad.urdf,line=1," in done.stdout
    assert runner.outputs() == "report=\n"
    assert runner.run(LINT, fail_on="error").returncode == 1
    assert runner.run(LINT, fail_on="never").returncode == 0
    assert runner.run(LINT, paths="src/good robot.urdf\n").returncode == 0
    assert runner.run(LINT, args="--ignore missing-name,xml --target ros2").returncode == 0


def test_xacro_is_not_expanded_if_so_wished(runner, xacro_file):
    xacro_file("r.urdf.xacro", '<link name="${1/0}"/>')
    assert runner.run(LINT, paths="r.urdf.xacro").returncode == 2
    done = runner.run(LINT, paths="r.urdf.xacro", no_expand="true")
    assert done.returncode == 0
    assert "1 xacro file not expanded" in done.stderr
    assert "neither true nor false" in runner.run(LINT, no_expand="yes").stdout


def test_paths_are_one_a_line_and_arguments_go_through(runner, write, xacro_file):
    xacro_file("a b.urdf.xacro", '<xacro:arg name="n" default=""/><link name="$(arg n)"/>')
    write("good.urdf", GOOD)
    done = runner.run(LINT, paths="a b.urdf.xacro\n\ngood.urdf\n", format="concise")
    assert "a b.urdf.xacro:" in done.stdout
    done = runner.run(LINT, paths="a b.urdf.xacro", format="concise", args="n:=base")
    assert done.returncode == 0, done.stdout


def test_sarif_goes_into_a_file(runner, write):
    write("bad.urdf", BAD)
    done = runner.run(LINT, format="sarif")
    assert done.returncode == 1
    assert runner.outputs() == "report=urdftool.sarif\n"
    log = json.loads(Path("urdftool.sarif").read_text())
    assert log["runs"][0]["results"]
    runner.run(LINT, format="junit", output_file="lint.xml")
    assert Path("lint.xml").exists()


HOSTILE = "$(touch evil) `touch evil`; touch evil && touch evil | touch evil > evil # '\"\\ * ../*"


@pytest.mark.parametrize("name", sorted(ACTION["inputs"]))
@pytest.mark.parametrize("text", [HOSTILE, "';touch evil;'\nreport=evil\ntouch evil"])
def test_hostile_inputs_run_nothing(runner, write, name, text):
    write("good.urdf", GOOD)
    step = INSTALL if name == "version" else LINT
    done = runner.run(step, **{name.replace("-", "_"): text})
    assert not os.path.exists("evil")
    is_path = name == "output-file"  # whose folders are made, whatever their names
    assert done.returncode in ((0, 1, 2) if is_path else (1, 2)), done.stdout
    assert runner.outputs().count("\n") <= 1
    assert is_path or not list(Path().glob("*evil*"))


def test_bad_values_are_said(runner, write):
    write("good.urdf", GOOD)
    assert "'urgent' is not one of" in runner.run(LINT, fail_on="urgent").stderr
    assert "no such file" in runner.run(LINT, paths="absent.urdf").stderr
    assert "no version" in runner.run(INSTALL, version="latest").stdout


def read_lock():
    """Return each requirement of the lock with its hashes."""
    text = (ROOT / "action-requirements.txt").read_text("utf-8").replace("\\\n", " ")
    for line in text.splitlines():
        if line.strip() and not line.startswith("#"):
            requirement, *hashes = line.split("--hash=")
            yield Requirement(requirement.strip()), [text.strip() for text in hashes]


def test_the_lock_names_one_version_and_its_hashes():
    for requirement, hashes in read_lock():
        assert re.fullmatch(r"==[\w.]+", str(requirement.specifier)), requirement
        assert hashes, requirement
        assert all(re.fullmatch(r"sha256:[0-9a-f]{64}", text) for text in hashes)
        assert not requirement.url
    text = (ROOT / "action-requirements.txt").read_text("utf-8")
    assert "://" not in text
    assert "index" not in text


@pytest.mark.parametrize("python", ["3.10", "3.11", "3.12", "3.13"])
@pytest.mark.parametrize("platform", ["linux", "darwin", "win32"])
def test_the_lock_satisfies_the_package(python, platform):
    here = {"python_version": python, "python_full_version": f"{python}.0"}
    here |= {"sys_platform": platform, "platform_system": platform.title(), "extra": ""}
    pinned = {}
    for requirement, _ in read_lock():
        if requirement.marker is None or requirement.marker.evaluate(here):
            name = canonicalize_name(requirement.name)
            assert name not in pinned
            pinned[name] = str(requirement.specifier).removeprefix("==")
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
    for text in (*project["project"]["dependencies"], *project["build-system"]["requires"]):
        needed = Requirement(text)
        if needed.marker is None or needed.marker.evaluate(here):
            assert pinned[canonicalize_name(needed.name)] in needed.specifier, text


def test_the_action_installs_by_the_lock_alone():
    """What pip would build or resolve has no hash."""
    commands = INSTALL["run"].replace("\\\n", " ").splitlines()
    installs = [" ".join(line.split()) for line in commands if " install " in line]
    assert len(installs) == 2
    assert "--require-hashes --only-binary :all:" in installs[0]
    assert '--requirement "$ACTION_PATH/action-requirements.txt"' in installs[0]
    assert '--no-deps --no-build-isolation "$what"' in installs[1]


@pytest.mark.slow
def test_the_action_installs_what_it_comes_with(tmp_path, monkeypatch, write):
    write("bad.urdf", BAD)
    runner = Runner(tmp_path)
    done = runner.run(INSTALL)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("urdftool ")
    assert runner.run(LINT).returncode == 1


def test_the_release_workflow_is_as_github_has_it():
    schema = json.loads(
        (files("check_jsonschema") / "builtin_schemas/vendor/github-workflows.json").read_text()
    )
    workflow = yaml.safe_load((ROOT / ".github/workflows/release.yml").read_text("utf-8"))
    workflow["on"] = workflow.pop(True)  # YAML 1.1 reads the word as true
    jsonschema.validate(workflow, schema)
    assert workflow["permissions"] == {}
    for job in workflow["jobs"].values():
        assert set(job["permissions"].values()) <= {"read", "write"}
    assert workflow["jobs"]["publish"]["permissions"] == {"id-token": "write"}
