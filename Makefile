# make run   creates the environment, installs, starts the lab and prints its address
# make test  all tests, headless Chromium included
# make fuzz  the property tests with random inputs; make test has the same ones every time
# make check lint, format, types      make bench  the speed table

PYTHON ?= python3
VENV   ?= .venv
BIN     = $(VENV)/bin
STAMP   = $(VENV)/.installed
PYTEST  = $(BIN)/pytest -n 2 --dist loadfile

.PHONY: run test fuzz check format bench wheel clean
.DEFAULT_GOAL := run

$(STAMP): pyproject.toml
	$(PYTHON) -m venv --clear $(VENV)
	$(BIN)/pip install --quiet --editable ".[dev]"
	touch $(STAMP)

run: $(STAMP)
	$(BIN)/onpath $(ARGS)

# In one run, so that both workers have something to do until its end.
test: $(STAMP)
	$(PYTEST) $(ARGS)

fuzz: $(STAMP)
	$(PYTEST) -m hypothesis --hypothesis-profile fuzz $(ARGS)

check: $(STAMP)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/pyright --pythonpath $(BIN)/python

format: $(STAMP)
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

bench: $(STAMP)
	$(BIN)/onpath bench $(ARGS)

wheel: $(STAMP)
	$(BIN)/python -m build --wheel

clean:
	rm -rf $(VENV) dist .pytest_cache .ruff_cache .hypothesis
