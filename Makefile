# make run   creates the environment, installs, starts the lab and prints its address
# make test  all tests, headless Chromium included
# make check lint, format, types      make bench  the speed table

PYTHON ?= python3
VENV   ?= .venv
BIN     = $(VENV)/bin
STAMP   = $(VENV)/.installed

.PHONY: run test check format bench wheel clean
.DEFAULT_GOAL := run

$(STAMP): pyproject.toml
	$(PYTHON) -m venv --clear $(VENV)
	$(BIN)/pip install --quiet --editable ".[dev]"
	touch $(STAMP)

run: $(STAMP)
	$(BIN)/onpath $(ARGS)

test: $(STAMP)
	$(BIN)/pytest -n 2 --dist loadfile --ignore-glob='*browser.py' $(ARGS)
	$(BIN)/pytest -n 2 --dist loadfile tests/test_*browser.py $(ARGS)

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
