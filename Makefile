# make run   creates the environment, installs, starts the lab and prints its address
# make test  the tests, headless Chromium included; adds what they need to the environment
# make thorough  tests that need minutes: the numbers that lessons state, whole servers and crowds,
#            processes that hang (.ci/run runs half of them, others every day)
# make pages the other tests in Chromium, of every page and dialog: an hour
# make fuzz  the property tests with random inputs; make test has the same ones every time
# make check lint, format, types, also of the pages' scripts      make bench  the speed tables
#            (make bench ARGS="--clients 60": a class of sixty)
# make soak  6 labs under attack for a minute, and 40 for half an hour, on a machine that does nothing else:
#            lateness, memory and log stay within bounds

PYTHON ?= python3
VENV   ?= .venv
BIN     = $(VENV)/bin
LAB     = $(VENV)/.installed
TOOLS   = $(VENV)/.tools
WEB     = assets/web
SCRIPTS = $(WEB)/node_modules/.package-lock.json
NPM     = PATH="$(abspath $(BIN)):$$PATH" npm --prefix $(WEB)
# Bytecode is kept beside the tools, whatever the environment says: the processes that tests start
# would compile all of OnPath again, each of them.
KEPT    = env -u PYTHONDONTWRITEBYTECODE PYTHONPYCACHEPREFIX=$(abspath $(VENV))/bytecode
QUICK   = "not thorough and not soak"
PYTEST  = $(KEPT) $(BIN)/pytest -n 2 --dist worksteal

.PHONY: run test thorough pages fuzz check format bench soak picture wheel clean
.DEFAULT_GOAL := run

# What running needs; --clear takes the tools away, too, and their stamp with them.
$(LAB): pyproject.toml
	$(PYTHON) -m venv --clear $(VENV)
	$(BIN)/pip install --quiet --editable .
	touch $(LAB)

# What tests, checks and the bench need besides.
$(TOOLS): $(LAB)
	$(BIN)/pip install --quiet --editable ".[dev]"
	touch $(TOOLS)

# What the pages' scripts are built, checked and tested with; Node is one of the tools.
$(SCRIPTS): $(TOOLS) $(WEB)/package-lock.json
	$(NPM) ci --silent
	touch $@

run: $(LAB)
	$(BIN)/onpath $(ARGS)

# Both parts run, whatever the first says: Playwright keeps a running event loop in its thread, with
# which other tests cannot share it.
test: $(TOOLS) $(SCRIPTS)
	@failed=0; \
	$(PYTEST) -m $(QUICK) --ignore=tests/in_browser $(ARGS) || failed=$$?; \
	$(PYTEST) -m $(QUICK) tests/in_browser $(ARGS) || failed=$$?; \
	exit $$failed

thorough: $(TOOLS)
	$(PYTEST) -m thorough --ignore=tests/in_browser $(ARGS)

pages: $(TOOLS)
	$(PYTEST) -m thorough -o timeout=1800 -o faulthandler_timeout=3600 tests/in_browser $(ARGS)

fuzz: $(TOOLS)
	$(PYTEST) -m hypothesis --hypothesis-profile fuzz $(ARGS)

# What onpath/__init__.py does for Python, pyright must see as folders.
build/onpath: Makefile
	rm -rf build
	mkdir -p $@
	ln -s ../../app ../../assets ../../lessons ../../models $@
	ln -s ../../onpath/__init__.py ../../onpath/__main__.py $@
	touch $@

check: $(TOOLS) $(SCRIPTS) build/onpath
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/pyright --pythonpath $(BIN)/python
	$(NPM) run --silent lint

format: $(TOOLS)
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

bench: $(TOOLS)
	$(BIN)/python -m tests.bench $(ARGS)

soak: $(TOOLS)
	$(PYTEST) -n 0 -m soak tests/bench
	$(BIN)/python -m tests.bench --soak 30 $(ARGS)

# The README's moving picture.
picture: $(TOOLS)
	$(BIN)/python -m tests.support.readme_picture

# The sdist, and the wheel from it.
wheel: $(TOOLS)
	$(BIN)/python -m build

clean:
	rm -rf $(VENV) $(WEB)/node_modules build dist .pytest_cache .ruff_cache .hypothesis
