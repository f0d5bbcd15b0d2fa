# `make demo` and `make test` need only make and Python >= 3.11 with pip.
PYTHON  ?= python3
VENV    ?= .venv
PY      := $(VENV)/bin/python
INSTALL ?= $(PY) -m pip install --disable-pip-version-check -q
# faster: make test INSTALL="uv pip install -p .venv"

DEMO_FLAGS  ?=
TEST_FLAGS  ?=
BENCH_FLAGS ?=

FOLDERS := core envs thermal assets hardware
FILES   := $(sort $(shell find $(FOLDERS) -name __pycache__ -prune -o -type f -print))

.PHONY: demo test test-ray test-backends test-rl test-grippers test-view test-view-long test-hardware-long test-firmware test-bench test-release bench docs lint install clean distclean FORCE
.NOTPARALLEL:
.DELETE_ON_ERROR:

demo: build/.run
	$(PY) -m thermograsp demo $(DEMO_FLAGS)

test: build/.test
	$(PY) -m pytest $(TEST_FLAGS)

# What needs Ray and Minari; without them `make test` skips it.
test-ray: build/.ray
	$(PY) -m pytest $(TEST_FLAGS) tests/ray

# What needs PyTorch and JAX; without them `make test` skips it.
test-backends: build/.backends
	$(PY) -m pytest $(TEST_FLAGS) tests/backends

# What needs stable-baselines3; without it `make test` skips it.
test-rl: build/.rl
	$(PY) -m pytest $(TEST_FLAGS) tests/rl

# Grippers from other packages; without them `make test` skips them.
test-grippers: build/.grippers
	$(PY) -m pytest $(TEST_FLAGS) tests/grippers

# The studio's page in Debian's chromium; without it and playwright `make test` skips these.
test-view: build/.view
	$(PY) -m pytest -rs $(TEST_FLAGS) tests/view

# An hour of grasps in the studio, in minutes, and dozens of visits: they leave nothing behind.
test-view-long: build/.view
	THERMOGRASP_LONG=1 $(PY) -m pytest -s $(TEST_FLAGS) tests/view/test_long.py tests/view/test_feeling.py

# The serial link for minutes: a kilohertz for one, a million corrupted frames, ten million random bytes.
test-hardware-long: build/.test
	THERMOGRASP_LONG=1 $(PY) -m pytest $(TEST_FLAGS) tests/hardware

# The firmware in a simulator, a part of `make test`; says which tools are missing where they are (docs/firmware.md).
test-firmware: build/.test
	$(PY) -m pytest -rs $(TEST_FLAGS) tests/hardware/test_firmware*.py

# Every benchmark, coarsely, and what they must show; the physics beside elements in 3-D; the demo and the paper's figures.
test-bench: build/.test
	THERMOGRASP_BENCH=1 $(PY) -m pytest $(TEST_FLAGS) tests/bench tests/benchmarks tests/thermal/test_mesh_fem.py \
	  tests/cli/test_demo.py tests/cli/test_reproduce.py

# What is published: a wheel and an sdist, installed where nothing else is, and the first page of docs/ done literally.
test-release: build/.release
	THERMOGRASP_RELEASE=1 $(PY) -m pytest $(TEST_FLAGS) tests/release

bench: build/.run
	$(PY) -m thermograsp bench $(BENCH_FLAGS)

# The site in build/site, where a warning is an error, and the code of its pages.
docs: build/.dev
	$(PY) -m sphinx -E -W --keep-going -q -b html docs build/site
	THERMOGRASP_SITE=build/site $(PY) -m pytest $(TEST_FLAGS) tests/docs

lint: build/.dev
	$(PY) -m ruff check .
	$(PY) -m ruff format --check .
	$(PY) -m pyright --pythonpath $(PY)

install: build/.test

# Stamps live in build/, beside the link tree they vouch for: removing build/ or .venv/, adding or removing a source
# file, or editing setup.cfg reinstalls.
build/.run: EXTRA :=
build/.test: EXTRA := [test]
build/.ray: EXTRA := [test,ray,minari]
build/.backends: EXTRA := [test,torch,jax]
build/.backends: PINS := torch==2.13.0
build/.view: EXTRA := [test]
build/.view: PINS := playwright
build/.rl: EXTRA := [test,rl]
build/.rl: PINS := torch==2.13.0
build/.grippers: EXTRA := [test,grippers]
# Of robosuite only the files are read, and what it depends on holds numpy back.
build/.grippers: ALONE := robosuite==1.5.2
build/.release: EXTRA := [release,test]
build/.dev: EXTRA := [dev]
build/.run build/.test build/.ray build/.backends build/.rl build/.grippers build/.view build/.release build/.dev: $(VENV)/.created build/.files setup.cfg pyproject.toml
	$(INSTALL) --no-build-isolation -e '.$(EXTRA)' $(PINS)
	$(if $(ALONE),$(INSTALL) --no-deps $(ALONE))
	@touch $@

build/.files: FORCE
	@mkdir -p build
	@printf '%s\n' $(FILES) | cmp -s - $@ || printf '%s\n' $(FILES) > $@

# Without ensurepip (Debian without python3-venv) the venv gets its pip from the system's pip.
$(VENV)/.created:
	@$(PYTHON) -c 'import sys; sys.exit("Python 3.11 or newer is needed: make PYTHON=..." if sys.version_info < (3, 11) else 0)'
	$(PYTHON) -m venv --clear $(VENV) || { \
	  $(PYTHON) -m venv --clear --without-pip $(VENV) && \
	  $(PYTHON) -m pip --python $(PY) install -q pip; }
	$(INSTALL) 'setuptools>=77'
	@touch $@

clean:
	rm -rf build dist *.egg-info .coverage .pytest_cache .ruff_cache

distclean: clean
	rm -rf $(VENV)
