# Two commands do everything: `make report` (the main job) and `make test`. Both first create .venv from the
# locked versions in requirements.lock.
PYTHON ?= python3
BIN := .venv/bin
# As commands do: the matrices are small, and threads of BLAS only wait for each other.
export OPENBLAS_NUM_THREADS ?= 1
# Commands and tests start many processes; without kept bytecode each would compile every module anew.
export PYTHONDONTWRITEBYTECODE :=

.PHONY: report reference screenshots site test test-slow test-robots test-mujoco test-sweep promises kernel kernel-slow fuzz lint types bench lock clean help

help:
	@echo "make report     check the paper's arm and gains for m = 1, 2, 3; writes reports/"
	@echo "make site       the documents as a site, in build/site/"
	@echo "make reference  write docs/reference/ from the code"
	@echo "make screenshots  pictures of the report in a real browser (needs chromium)"
	@echo "make test       the fast tests: every command, rule and kind of certificate once at least"
	@echo "make test-slow  the rest: whole grids, planted faults, 2,500 statements, many examples, built wheel"
	@echo "make test-robots  arms against Pinocchio and MuJoCo; downloads 1 GB; writes reports/robots.md"
	@echo "make test-mujoco  motions against MuJoCo; downloads 20 MB (extra mujoco)"
	@echo "make test-sweep   sweeps on a Dask cluster of this machine; downloads 80 MB (extra sweep)"
	@echo "make promises   what is promised over ranges, asked at 200 members a test; writes reports/promises.md"
	@echo "make kernel     the theorem and its definitions in Coq, formal/; needs coqc (Debian: coq libcoq-interval)"
	@echo "make kernel-slow  both checkers on every committed certificate; writes reports/kernel.md and what check knows of Coq"
	@echo "make fuzz       a million random statements against an oracle; hours"
	@echo "make lint       style (ruff), formatting and prose"
	@echo "make types      static types (mypy --strict)"
	@echo "make bench      benchmarks; writes reports/benchmarks.md"
	@echo "make lock       renew requirements.lock (needs uv)"

report: .venv/.ready
	$(BIN)/lyapcheck report

# Packages that only the site needs, in an environment of their own.
site:
	$(PYTHON) -m venv build/docs
	build/docs/bin/python -m pip install --quiet --disable-pip-version-check --require-hashes -r docs/requirements.lock
	build/docs/bin/sphinx-build --quiet --fail-on-warning --keep-going -d build/doctrees docs build/site

reference: .venv/.ready
	$(BIN)/python -m docs.generate

screenshots: .venv/.ready
	$(BIN)/python -m tests.report.screenshots

test: .venv/.ready
	$(BIN)/pytest -n 2 --dist loadfile -m "not slow"

test-slow: .venv/.ready
	$(BIN)/pytest -n 2 --dist worksteal -m "slow or hypothesis" --hypothesis-profile thorough

# Packages that these tests need; writes reports/robots.md.
test-robots: .venv/.ready
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable ".[robots,mjcf,xacro]"
	$(BIN)/pytest tests/robots/against_pinocchio.py tests/robots/against_mujoco.py tests/robots/corpus.py

test-mujoco: .venv/.ready
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable ".[mujoco]"
	$(BIN)/pytest tests/simulate/against_mujoco.py

test-sweep: .venv/.ready
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable ".[sweep]"
	$(BIN)/pytest tests/sweep/on_a_cluster.py

promises: .venv/.ready
	$(BIN)/python -m tests.promises.record

# Only this target needs Coq; it installs nothing by itself.
kernel:
	@command -v coqc > /dev/null || \
	  { echo "make kernel needs Coq: apt-get install --no-install-recommends coq libcoq-interval"; exit 2; }
	@$(MAKE) --no-print-directory -C formal golden

kernel-slow: .venv/.ready kernel
	$(BIN)/python -m tests.kernel.figures --folder build/kernel

fuzz: .venv/.ready
	$(BIN)/python -m tests.statement_fuzz --statements 1000000 --seed 1122 --jobs 2

lint: .venv/.ready
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/python -m tests.house.prose

types: .venv/.ready
	$(BIN)/mypy

# Packages that only the benchmarks need; users never do.
bench: .venv/.ready
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable ".[bench]"
	$(BIN)/python -m tests.benchmarks

# The stamp is written last: an interrupted set-up starts again.
.venv/.ready: requirements.lock pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "lyapcheck needs Python 3.11 or newer; name one: make PYTHON=python3.12 $(MAKECMDGOALS)"; exit 2; }
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes -r requirements.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable .
	@touch $@

lock:
	uv pip compile pyproject.toml --group dev --universal --python-version 3.11 --generate-hashes \
	  --no-emit-index-url --no-header --no-annotate --quiet -o requirements.lock
	uv pip compile --group pyproject.toml:gate --universal --python-version 3.11 --generate-hashes \
	  --no-emit-index-url --no-header --no-annotate --quiet -o gate.lock
	uv pip compile --group pyproject.toml:docs --universal --python-version 3.11 --generate-hashes \
	  --no-emit-index-url --no-header --no-annotate --quiet -o docs/requirements.lock

clean:
	rm -rf .venv build dist .pytest_cache .mypy_cache .ruff_cache .hypothesis
