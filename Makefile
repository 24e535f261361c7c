# Needs Python 3.11, make and a C library. Everything else arrives in .venv.
PYTHON ?= $(shell command -v python3.11 || command -v python3)
VENV := .venv
VM_KERNEL ?= out/vm/kernel
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed

.PHONY: demo paper serve report screenshots test test-vm benchmark kills schema check format clean help

help:            ## this list
	@grep -E '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*##/\t/'

$(STAMP): pyproject.toml constraints.txt
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info[:2] != (3, 11))' 2>/dev/null \
	    || { echo "Python 3.11 is needed, found '$(PYTHON)'; if it is elsewhere: make PYTHON=/path/to/python3.11"; exit 1; }
	$(PYTHON) -m venv $(VENV)
	$(BIN)/pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable '.[dev,test]'
	touch $@

demo: $(STAMP)   ## the main job, end to end: tables on the terminal, one HTML report in out/
	$(BIN)/friction-bench demo --report out/demo.html

paper: $(STAMP)  ## every figure and table of the paper, ours beside it: one HTML report in out/
	mkdir -p out
	$(BIN)/friction-bench --store out/paper.sqlite paper --report out/paper.html

serve: $(STAMP)  ## the service and the page on the simulated bench
	$(BIN)/friction-bench serve

test: $(STAMP)   ## the tests: on all cores, and then those that the wall clock times, which mostly wait; drives on a wire by themselves
	@failed=0; \
	$(BIN)/pytest --numprocesses auto --dist loadfile -m 'not wall_clock' || failed=1; \
	$(BIN)/pytest --numprocesses 2 --dist loadfile -m wall_clock --ignore=tests/drivers || failed=1; \
	$(BIN)/pytest tests/drivers -m wall_clock || failed=1; \
	exit $$failed

report: $(STAMP) ## has a change made the bench worse? beside bench-baseline.json, as table, JUnit XML and HTML in out/
	$(BIN)/friction-bench bench-report --junit out/bench-report.xml --html out/bench-report.html

screenshots: $(STAMP) ## the walk of docs/tutorial/walk.md in Chromium, every view, light and dark: pictures in out/walk
	$(BIN)/python -m tests.browser.screenshots out/walk

test-vm: $(STAMP) ## the CANopen driver on the kernel's own CAN, in a guest; tests/vm/README.md says what it needs
	PYTHON=$(BIN)/python tests/vm/run.sh $(VM_KERNEL)

benchmark: $(STAMP) ## how fast plant, bench and start are, plant beside MuJoCo, store and export beside pandas, drivers beside their libraries, diagnosis and rows
	$(BIN)/pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable '.[bench]'
	$(BIN)/python -m tests.sim_backend.rates
	$(BIN)/python -m tests.store.rates
	$(BIN)/python -m tests.service.rates
	$(BIN)/python -m tests.drivers.rates
	$(BIN)/python -m tests.lab.rates

kills: $(STAMP)  ## 200 runs ended at random moments, in every way, on a drive in a process of its own: what is left of each
	$(BIN)/python -m tests.stopping.kills --kills 200

schema: $(STAMP) ## every route of the interface asked with many requests that fit its description, and many that do not
	SCHEMA_EXAMPLES=100 $(BIN)/pytest tests/service/test_schema.py --timeout=3600

check: $(STAMP)  ## style, types and walls
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

format: $(STAMP) ## rewrite in the project's style
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

clean:           ## remove the environment and everything made
	rm -rf $(VENV) out .mypy_cache .ruff_cache .pytest_cache .hypothesis
