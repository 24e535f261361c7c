# Needs Linux with glibc, Python 3.11 and make. Everything else arrives in .venv.
PYTHON ?= $(shell command -v python3.11 || command -v python3)
VENV := .venv
VM_KERNEL ?= out/vm/kernel
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
PIP := $(BIN)/pip install --quiet --disable-pip-version-check --constraint constraints.txt

.PHONY: help demo paper serve test test-services test-drivers test-virtual test-others collect steady check format docs \
        report screenshots pictures benchmark kills fuzz test-vm dist dist-test audit sbom hashes clean

help:            ## this list
	@awk -F ':.*## *' '/^[a-z-]+:.*##/ { printf "%-13s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

$(STAMP): pyproject.toml constraints.txt
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info[:2] != (3, 11))' 2>/dev/null \
	    || { echo "Python 3.11 is needed, found '$(PYTHON)'; if it is elsewhere: make PYTHON=/path/to/python3.11"; exit 1; }
	@echo "Installing into $(VENV): some minutes, the first time and after a change of what is needed."
	$(PYTHON) -m venv $(VENV)
	$(PIP) --editable '.[dev,docs,test]'
	touch $@

# To try it

demo: $(STAMP)   ## the main job, end to end, in seconds once it is installed: tables here, a report in out/demo.html
	$(BIN)/friction-bench demo --report out/demo.html

paper: $(STAMP)  ## every figure and table of the paper, ours beside it, in minutes: a report in out/paper.html
	mkdir -p out
	$(BIN)/friction-bench --store out/paper.sqlite paper --report out/paper.html

serve: $(STAMP)  ## the service and the page on the simulated bench
	$(BIN)/friction-bench serve

# To work on it

test: $(STAMP)   ## the tests: first those that only compute or run in virtual time, then those that the wall clock times, alone
	@failed=0; for part in test-others test-virtual test-services test-drivers; do $(MAKE) --no-print-directory $$part || failed=1; done; \
	    exit $$failed

test-services: $(STAMP)  ## those that the wall clock times: services and browsers
	$(BIN)/pytest --numprocesses 2 -m wall_clock --ignore=tests/drivers

test-drivers: $(STAMP)  ## of these, drivers on real ports: a cycle that is late is a fault there
	$(BIN)/pytest --numprocesses $$($(BIN)/python -m tests.devices.turns) -m wall_clock tests/drivers

test-virtual: $(STAMP)  ## drivers and simulated devices in one process, in virtual time: a busy machine changes nothing
	$(BIN)/pytest -p tests.virtual.plugin --numprocesses auto -m virtual_time tests/drivers

test-others: $(STAMP)  ## the tests that only compute, on all cores
	$(BIN)/pytest --numprocesses auto --timeout=600 -m 'not wall_clock and not virtual_time'

collect: $(STAMP) ## find every test and run none: what the runs after it import is compiled then
	@mkdir -p out
	$(BIN)/pytest --collect-only -qq >out/collected.txt || { cat out/collected.txt; exit 1; }

steady: $(STAMP) ## the tests that hang on seconds, 20 times in a row: which of them fails when
	$(BIN)/python -m tests.steady 20

check: $(STAMP)  ## style, types and walls; .pre-commit-config.yaml runs the same
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

format: $(STAMP) ## rewrite in the project's style
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

docs: $(STAMP)   ## the documents as a site in out/docs, without network; a warning or a broken link is an error
	$(BIN)/sphinx-build --quiet --fail-on-warning --keep-going --doctree-dir out/doctrees docs out/docs
	$(BIN)/python -m docs.generate.site out/docs

report: $(STAMP) ## has a change made the bench worse? beside bench-baseline.json: table, JUnit XML and HTML in out/
	$(BIN)/friction-bench bench-report --junit out/bench-report.xml --html out/bench-report.html

screenshots: $(STAMP) ## the walk of docs/tutorial/walk.md in Chromium, every view, light and dark: out/walk
	$(BIN)/python -m tests.browser.screenshots out/walk

pictures: $(STAMP) ## the pictures of README.md and of the guides, taken in Chromium: docs/pictures
	$(BIN)/python -m tests.browser.pictures docs/pictures
	$(BIN)/python -m tests.browser.commission_pictures docs/pictures

benchmark: $(STAMP) ## rates of plant, store, service, drivers, lab and command line, beside other libraries
	$(PIP) --editable '.[bench]'
	$(BIN)/python -m tests.cli.start_times
	$(BIN)/python -m tests.sim_backend.rates
	$(BIN)/python -m tests.store.rates
	$(BIN)/python -m tests.service.rates
	$(BIN)/python -m tests.drivers.rates
	$(BIN)/python -m tests.lab.rates

kills: $(STAMP)  ## 200 runs ended at random moments in every way, by itself, and beside a laboratory and on a server's store
	$(BIN)/python -m tests.stopping.kills --kills 200
	$(BIN)/python -m tests.stopping.kills --kills 200 --lab --server

fuzz: $(STAMP)   ## what is drawn at random, for long: requests, files, bytes on every wire; goes on where it was ended
	FUZZ_TIMES=40 $(BIN)/pytest --numprocesses auto --timeout=7200 tests/fuzz
	rm -f out/fuzz/passed.txt

test-vm: $(STAMP) ## the CANopen driver on the kernel's own CAN, in a guest; tests/vm/README.md says what it needs
	PYTHON=$(BIN)/python tests/vm/run.sh $(VM_KERNEL)

# To release it

dist: $(STAMP)   ## wheel and sdist in dist/
	rm -rf dist
	$(BIN)/python -m build --no-isolation

# What it is made of

audit: $(STAMP)  ## known vulnerabilities of the pinned versions; one that nobody could look up is an error, too
	$(PIP) --editable '.[supply]'
	$(BIN)/python -m tests.release.audit

sbom: $(STAMP)   ## what is installed, with licences, as CycloneDX: out/sbom.json
	$(PIP) --editable '.[supply]'
	mkdir -p out
	$(BIN)/cyclonedx-py environment --pyproject pyproject.toml --output-reproducible --output-format JSON \
	    --output-file out/sbom.json $(BIN)/python

hashes: $(STAMP) ## after a change of constraints.txt: hashes.txt, the hashes of all pinned versions
	$(PIP) --editable '.[supply]'
	$(BIN)/uv pip compile --quiet --no-deps --generate-hashes --no-annotate --no-header --no-emit-index-url \
	    --python $(BIN)/python --output-file hashes.txt constraints.txt

dist-test: dist  ## demo and service from the wheel alone, in a new environment outside the checkout
	$(BIN)/python -m tests.release.from_wheel dist

clean:           ## remove the environment and everything made: .venv, dist, and all of out, with out/demo.sqlite
	rm -rf $(VENV) out dist docs/reference/generated .mypy_cache .ruff_cache .pytest_cache .hypothesis
