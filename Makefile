# Two commands do all the set-up: `make demo` shows what urdftool does, `make test` runs its tests.

PYTHON ?= python3
VENV   ?= .venv
BIN    := $(VENV)/bin
DEMO   := fixtures/robots/demo_arm/urdf/arm.urdf.xacro
SOUND  := fixtures/robots/demo_arm/urdf/arm_sound.urdf.xacro
# tests on every core; a worker without work takes tests of another
PARALLEL := -n auto --maxprocesses 8 --dist worksteal

.PHONY: demo dev quick rule check-rule test test-core test-programs test-all check format docs site bench bench-peers fidelity record compare \
  clean

$(BIN)/urdftool: pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[all]'
	$(BIN)/python -m compileall -q urdftool
	@touch $@

$(VENV)/.dev: pyproject.toml $(BIN)/urdftool
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev]'
	@touch $@

$(VENV)/.docs: $(VENV)/.dev
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[docs]'
	@touch $@

# lint exits 1 because the demo robot has mistakes; anything else is a failure.
demo: $(BIN)/urdftool
	$(BIN)/urdftool expand $(DEMO) prefix:=left_ -o $(VENV)/left_arm.urdf
	@echo "wrote $(VENV)/left_arm.urdf"
	$(BIN)/urdftool lint $(DEMO) prefix:=left_; test $$? -eq 1
	$(BIN)/urdftool info $(SOUND)
	$(BIN)/urdftool graph $(SOUND) -o -
	$(BIN)/urdftool inertia robot $(SOUND)
	$(BIN)/urdftool export sdf $(SOUND) -o $(VENV)/demo_arm --verify
	$(BIN)/urdftool collision mesh fixtures/meshes/cube.stl --method hull --no-cache

# what most changes need: no simulator, no mesh library
dev:
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev-core]'

# some 4,000 tests of all parts in less than a minute, in one process; `make test` runs all
quick:
	$(BIN)/python -m pytest -q -p no:xdist -m quick

# make rule NAME=heavy-damping FILE=joint/drive: the function and two robots, to be written;
# make check-rule NAME=heavy-damping: its row in the table, fixtures, page, stated effects
rule:
	$(BIN)/python -m tests.new_rule $(NAME) $(FILE)

check-rule:
	$(BIN)/python -m tests.rule_table
	$(BIN)/python docs/generate.py --rule $(NAME)
	$(BIN)/python -m pytest -q -k $(NAME) tests/rules/test_fixtures.py tests/effects/test_table.py

test: $(VENV)/.dev
	$(BIN)/python -m pytest -m "not slow" $(PARALLEL)

# the command line as pip installs it without an extra, from wheels alone; tests of single rules, of
# caches and threads do not depend on extras: make test-core CORE_TESTS=tests
CORE := build/core
CORE_TESTS := tests/commands tests/graph tests/info tests/test_extras.py tests/rules/test_fixtures.py \
  $(filter-out %_cache.py %_dependencies.py %_threads.py,$(wildcard tests/lint/test_*.py))
test-core:
	rm -rf $(CORE)
	$(PYTHON) -m venv $(CORE)
	$(CORE)/bin/python -m pip install --quiet --disable-pip-version-check --compile --only-binary :all: .
	$(CORE)/bin/python -m tests.installed_size
	$(CORE)/bin/python -m pip install --quiet --disable-pip-version-check --only-binary :all: '.[test-core]'
	$(CORE)/bin/python -m pytest -q -m "not slow" $(PARALLEL) $(CORE_TESTS)

# tests of other programs: Gazebo's reader, Graphviz, other shells; the default run does not see them
test-programs: $(VENV)/.dev
	$(BIN)/python -m pytest -m "program and not slow"

test-all: $(VENV)/.dev
	$(BIN)/python -m pytest $(PARALLEL)

check: $(VENV)/.dev
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy

format: $(VENV)/.dev
	$(BIN)/ruff format
	$(BIN)/ruff check --fix

docs: $(VENV)/.dev
	$(BIN)/python docs/generate.py

site: $(VENV)/.docs
	$(BIN)/python -m sphinx -W --keep-going -n -b html -d build/trees docs build/site
	@echo "build/site/index.html"

# What urdftool is measured beside: the other tools in an environment of their own, then all that
# takes no long time, into docs/measurements/benchmarks.md; `make fidelity` takes longer, for docs/measurements/fidelity.md.
bench: $(VENV)/.dev
	$(BIN)/python -m measure.benchmarks --write

bench-peers: $(VENV)/.dev
	$(BIN)/python -m measure.benchmarks.peers

fidelity: $(VENV)/.dev
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev,fidelity]'
	$(BIN)/python -m measure.benchmarks.fidelity --write --jobs 2

# a case again: python -m measure.fuzz --seed 2026 --only NUMBER
CASES ?= 20000
fuzz: $(VENV)/.dev
	@mkdir -p build
	$(BIN)/python -m measure.fuzz --seed 2026 --cases $(CASES) --log build/fuzz.jsonl --write

platforms: $(VENV)/.dev
	$(BIN)/python -m pip install --quiet --disable-pip-version-check nox
	$(BIN)/nox

# what commands print and write: `make record` before a change, `make compare` after it
record: $(VENV)/.dev
	$(BIN)/python -m measure.record record build/record

compare: $(VENV)/.dev
	$(BIN)/python -m measure.record record build/record-now
	$(BIN)/python -m measure.record compare build/record build/record-now

clean:
	rm -rf $(VENV) build dist .pytest_cache .mypy_cache .ruff_cache .hypothesis
