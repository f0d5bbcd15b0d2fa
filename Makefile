# `make demo` and `make test` need only make and Python >= 3.11 with pip.
PYTHON  ?= python3
VENV    ?= .venv
PY      := $(VENV)/bin/python
INSTALL ?= $(PY) -m pip install --disable-pip-version-check -q
# faster: make test INSTALL="uv pip install -p .venv"

# Where the environment forbids to keep compiled Python, every process of a run would compile all sources again.
export PYTHONDONTWRITEBYTECODE :=

DEMO_FLAGS  ?=
TEST_FLAGS  ?=
WORKERS     ?= 3
BENCH_FLAGS ?=

FOLDERS := core envs touch thermal assets hardware agents figures dataset studio twin reports benchmarks
FILES   := $(sort $(shell find $(FOLDERS) -name __pycache__ -prune -o -type f -print))

.PHONY: demo test test-slow test-ray test-backends test-rl test-grippers test-engine test-engines test-mjlab test-lerobot test-oldest test-view test-view-long test-hardware-long test-firmware test-bench test-release bench docs reference lint install clean distclean FORCE
.NOTPARALLEL:
.DELETE_ON_ERROR:

demo: build/.run
	$(PY) -m thermograsp demo $(DEMO_FLAGS)

# Side by side in as many processes as WORKERS says; each takes its part of the tests in their order, then what is left.
# One more than two cores can run: tests of serial lines and of the studio do nothing but wait for some 50 s in all.
test: build/.test
	$(PY) -m pytest -n $(WORKERS) --dist worksteal $(TEST_FLAGS)

# Proofs that take long: tests marked slow, which `make test` skips.
test-slow: build/.test
	THERMOGRASP_SLOW=1 $(PY) -m pytest -n $(WORKERS) --dist worksteal -m slow $(TEST_FLAGS)

# What needs Ray and Minari; without them `make test` skips it.
test-ray: build/.ray
	$(PY) -m pytest $(TEST_FLAGS) tests/ray

# What needs PyTorch, JAX and MJX; without them `make test` skips it.
test-backends: build/.backends
	$(PY) -m pytest $(TEST_FLAGS) tests/backends

# What needs stable-baselines3, PyTorch and TorchRL; without them `make test` skips it.
test-rl: build/.rl
	THERMOGRASP_SLOW=1 $(PY) -m pytest $(TEST_FLAGS) tests/rl tests/docs/test_notebooks.py

# Grippers from other packages; without them `make test` skips them.
test-grippers: build/.grippers
	$(PY) -m pytest $(TEST_FLAGS) tests/grippers

# Heat inside MuJoCo's step: the sanitizers, and a million random steps.
test-engine: build/.test
	THERMOGRASP_ENGINE=1 $(PY) -m pytest -rs $(TEST_FLAGS) tests/touch/test_engine*.py

# Environments of other packages, in an environment of their own with the MuJoCo that all of them run on. A package that
# cannot be installed says so, and its tests are skipped. Of robosuite what it needs comes by hand: its list holds numpy back.
ENGINES := build/engines
ENGINE_MUJOCO := mujoco==3.3.7
ENGINE_INSTALL := $(ENGINES)/bin/python -m pip install --disable-pip-version-check -q
test-engines: build/.files
	$(MAKE) --no-print-directory $(ENGINES)/.created VENV=$(ENGINES)
	$(ENGINE_INSTALL) --no-build-isolation -e . $(ENGINE_MUJOCO) pytest
	for packages in gymnasium-robotics==1.4.2 dm_control==1.0.34 "h5py opencv-python-headless termcolor tqdm pynput imageio"; do \
	  $(ENGINE_INSTALL) $$packages $(ENGINE_MUJOCO) || echo "test-engines: $$packages cannot be installed here"; done
	$(ENGINE_INSTALL) --no-deps robosuite==1.5.2 || echo "test-engines: robosuite cannot be installed here"
	$(ENGINE_INSTALL) --no-deps metaworld==3.1.1 || echo "test-engines: metaworld cannot be installed here"
	THERMOGRASP_ENGINES=1 MUJOCO_GL=egl $(ENGINES)/bin/python -m pytest -rs $(TEST_FLAGS) tests/engines

# mjlab's worlds with heat, in an environment of their own: 2.5 GB with PyTorch for the CPU alone, else 7 GB. mujoco-warp's
# kernels are compiled into it at the first run.
MJLAB := build/mjlab
MJLAB_INSTALL := $(MJLAB)/bin/python -m pip install --disable-pip-version-check -q
MJLAB_ROOM := 8000000
test-mjlab: build/.files
	@if [ ! -e $(MJLAB)/.installed ] && [ $$(df -Pk . | awk 'NR == 2 {print $$4}') -lt $(MJLAB_ROOM) ]; then \
	  echo "test-mjlab: skipped, mjlab needs 8 GB of room"; \
	elif $(MAKE) --no-print-directory $(MJLAB)/.created VENV=$(MJLAB) && { [ -e $(MJLAB)/.installed ] || \
	  $(MJLAB_INSTALL) mjlab==1.6.0 'mujoco-warp==3.11.*' torch==2.13.0 pytest; }; then \
	  touch $(MJLAB)/.installed && $(MJLAB_INSTALL) --no-build-isolation -e . && \
	  THERMOGRASP_MJLAB=1 WARP_CACHE_PATH=$(CURDIR)/$(MJLAB)/warp $(MJLAB)/bin/python -m pytest -rs $(TEST_FLAGS) tests/mjlab; \
	else \
	  echo "test-mjlab: skipped, mjlab cannot be installed here"; fi

# LeRobot's datasets and robots, in an environment of their own: 2 GB with PyTorch for the CPU alone, else 7 GB. Of LeRobot
# what datasets and robots need comes by hand: its list brings CUDA, rerun, diffusers and wandb, which nothing here uses,
# and holds PyTorch back.
LEROBOT := build/lerobot
LEROBOT_INSTALL := $(LEROBOT)/bin/python -m pip install --disable-pip-version-check -q --no-warn-conflicts
LEROBOT_ROOM := 8000000
LEROBOT_NEEDS := torch==2.13.0 torchvision==0.28.0 'datasets<5' draccus==0.10.0 'huggingface-hub<0.36' 'av<16' 'packaging<26' \
  'numpy<2.3' 'deepdiff<9' 'einops<0.9' jsonlines safetensors termcolor psutil pytest
test-lerobot: build/.files
	@if [ ! -e $(LEROBOT)/.installed ] && [ $$(df -Pk . | awk 'NR == 2 {print $$4}') -lt $(LEROBOT_ROOM) ]; then \
	  echo "test-lerobot: skipped, LeRobot needs 8 GB of room"; \
	elif $(MAKE) --no-print-directory $(LEROBOT)/.created VENV=$(LEROBOT) && { [ -e $(LEROBOT)/.installed ] || { \
	  $(LEROBOT_INSTALL) $(LEROBOT_NEEDS) && $(LEROBOT_INSTALL) --no-deps lerobot==0.4.4 'accelerate<2'; }; }; then \
	  touch $(LEROBOT)/.installed && $(LEROBOT_INSTALL) --no-build-isolation -e '.[dataset,hardware]' && \
	  THERMOGRASP_LEROBOT=1 HF_HUB_OFFLINE=1 HF_HOME=$(CURDIR)/$(LEROBOT)/home $(LEROBOT)/bin/python -m pytest -rs $(TEST_FLAGS) tests/lerobot; \
	else \
	  echo "test-lerobot: skipped, LeRobot cannot be installed here"; fi

# The oldest packages that setup.cfg allows, in an environment of their own: touch on the oldest MuJoCo, and the
# environments on the oldest that they run on. What proves heat alone, whoever makes the contacts, is left to the newest
# packages.
OLDEST := build/oldest
LAWS := as_a_press contents ellipsoids fixed_places narrow padded_fingertips remembered_places ripple round_off slipped_meshes
test-oldest: build/.files
	rm -rf $(OLDEST)
	$(MAKE) --no-print-directory $(OLDEST)/.created VENV=$(OLDEST)
	$(PYTHON) .ci/oldest.py > $(OLDEST)/pins.txt
	$(OLDEST)/bin/python -m pip install --disable-pip-version-check -q -r $(OLDEST)/pins.txt pytest hypothesis pyserial pyyaml
	$(OLDEST)/bin/python -m pip install --disable-pip-version-check -q --no-deps --no-build-isolation -e .
	$(OLDEST)/bin/python -m pytest $(TEST_FLAGS) tests/touch tests/thermal/numerics $(LAWS:%=--ignore=tests/touch/test_%.py)
	$(OLDEST)/bin/python -m pip uninstall -q -y mujoco
	$(OLDEST)/bin/python -m pip install --disable-pip-version-check -q mujoco==4.0
	$(OLDEST)/bin/python -m pytest $(TEST_FLAGS) tests/envs/mechanics tests/envs/gym/test_gymnasium_protocol.py tests/thermal/batch

# The studio's page in Debian's chromium; without it and playwright `make test` skips these.
test-view: build/.view
	$(PY) -m pytest -rs $(TEST_FLAGS) tests/studio

# An hour of grasps in the studio, in minutes, and dozens of visits: they leave nothing behind.
test-view-long: build/.view
	THERMOGRASP_LONG=1 $(PY) -m pytest -s $(TEST_FLAGS) tests/studio/test_long.py tests/studio/test_feeling.py

# The serial link for minutes: a kilohertz for one, a million corrupted frames, ten million random bytes.
test-hardware-long: build/.test
	THERMOGRASP_LONG=1 $(PY) -m pytest $(TEST_FLAGS) tests/hardware

# The firmware in a simulator, with what `make test` leaves out of it; says which tools are missing where they are
# (docs/firmware.md).
test-firmware: build/.test
	THERMOGRASP_SLOW=1 $(PY) -m pytest -rs $(TEST_FLAGS) tests/hardware/test_firmware*.py

# Every benchmark, coarsely, and what they must show; the physics beside elements in 3-D; the demo and the paper's figures.
test-bench: build/.test
	THERMOGRASP_BENCH=1 $(PY) -m pytest $(TEST_FLAGS) tests/bench tests/studies tests/thermal/meshes/test_mesh_fem.py \
	  tests/cli/test_demo.py tests/cli/test_reproduce.py

# What is published: a wheel and an sdist, installed where nothing else is, and the first page of docs/ done literally.
test-release: build/.release
	THERMOGRASP_RELEASE=1 $(PY) -m pytest $(TEST_FLAGS) tests/release

bench: build/.run
	$(PY) -m thermograsp bench $(BENCH_FLAGS)

# The tables of docs/ that are made of the code, written again into their pages.
reference: build/.dev
	$(PY) docs/_ext/write_tables.py

# The site in build/site, where a warning is an error, and the code of its pages.
docs: build/.dev
	$(PY) -m sphinx -E -W --keep-going -q -b html docs build/site
	THERMOGRASP_SITE=build/site $(PY) -m pytest -n $(WORKERS) --dist worksteal $(TEST_FLAGS) tests/docs

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
build/.backends: PINS := torch==2.13.0 mujoco-mjx==3.17.0
build/.view: EXTRA := [test]
build/.view: PINS := playwright
build/.rl: EXTRA := [test,rl]
# RLlib by its parts: its extra holds Gymnasium back for all the other tiers.
build/.rl: PINS := torch==2.13.0 torchrl ray dm-tree lz4 ormsgpack pyyaml pandas tensorboardX requests pyarrow fsspec pydantic
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
