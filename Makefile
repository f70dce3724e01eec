# make serve: the study, ready for a participant      make test: everything that CI checks
# Both set up what they need: a virtual environment, the packages, for the tests a browser.

VENV := .venv
BIN := $(VENV)/bin
PORT ?= 8000
PYTHON ?= $(shell for python in python3.14 python3.13 python3.12 python3.11 python3; do \
	$$python -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && echo $$python && break; done)
AS_ROOT := $(shell [ "$$(id -u)" = 0 ] || echo sudo -n)

.PHONY: serve test screenshot clean

serve: $(VENV)/installed
	@$(BIN)/goalguess serve --port $(PORT)

test: $(VENV)/installed-for-tests
	$(BIN)/python -m tests.browser.chromium
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/python -m pytest -n auto

screenshot: $(VENV)/installed-for-tests
	$(BIN)/python -m tests.browser.chromium
	$(BIN)/python -m tests.browser.screenshot

clean:
	rm -rf $(VENV) dist .pytest_cache .mypy_cache .ruff_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

$(VENV)/installed: pyproject.toml | $(BIN)/python
	$(BIN)/python -m pip install --quiet --editable .
	@touch $@

$(VENV)/installed-for-tests: pyproject.toml | $(BIN)/python
	$(BIN)/python -m pip install --quiet --editable '.[test]'
	@touch $@ $(VENV)/installed

# Debian ships Python without the part of venv that brings pip.
$(BIN)/python:
	@test -n "$(PYTHON)" || { echo "Goalguess needs Python 3.11 or newer; none was found." >&2; exit 1; }
	@$(PYTHON) -m venv $(VENV) || { rm -rf $(VENV); echo "Installing python3-venv." >&2; \
		$(AS_ROOT) apt-get update -qq && $(AS_ROOT) apt-get install -qq -y python3-venv && $(PYTHON) -m venv $(VENV); } \
		|| { rm -rf $(VENV); echo "Goalguess needs Python's venv module (on Debian: python3-venv)." >&2; exit 1; }
