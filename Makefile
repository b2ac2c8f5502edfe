PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
UV := $(or $(wildcard $(BIN)/uv),$(shell command -v uv 2>/dev/null))
RUN := $(VENV)/.stamp-run
DEV := $(VENV)/.stamp-dev
PROBLEMS := $(sort $(patsubst problems/%.toml,%,$(wildcard problems/*.toml)))
# where a search of kinks or of boxes stops is decided by rounding, which no two kinds of processors share
UNSTEADY := own_search loader_optimal

# More BLAS threads change the order of summation, and with it the last digits of a table.
export OMP_NUM_THREADS := 1
export OPENBLAS_NUM_THREADS := 1
export MKL_NUM_THREADS := 1
export MPLBACKEND := Agg

# uv takes a fifth of the time of pip, which installs all where uv cannot
pip = $(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt
with_uv = pip install --quiet --compile-bytecode --python $(BIN)/python -c constraints.txt -e
ifdef UV
install = $(UV) $(with_uv) $(1)
else
install = { $(BIN)/python -m pip --version >/dev/null 2>&1 || $(BIN)/python -m ensurepip >/dev/null; } \
	&& { { $(pip) uv && $(BIN)/uv $(with_uv) $(1); } || $(pip) -e $(1); }
endif

.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
.PHONY: help table ledger atlas test test-long test-random wheel check-wheel mutants lint format docs bench results check-results check-proofs constraints clean

help: ## list the targets
	@sed -nE 's/^([a-z-]+):[^#]*## (.*)/  make \1|\2/p' Makefile | awk -F'|' '{ printf "%-22s %s\n", $$1, $$2 }'

table: $(RUN) ## set everything up and regenerate the table of optimal laws
	$(BIN)/optlaws run optimal_table

ledger: $(RUN) ## compute the printed items of the papers again, with their verdicts
	$(BIN)/optlaws run ledger

atlas: $(RUN) ## solve the atlas of optimal laws again
	$(BIN)/optlaws run atlas

test: $(DEV) ## run the tests, the doctests and the documents
	$(BIN)/python -m pytest -n 2

test-long: $(DEV) ## run the tests that take long, and those of random examples with all of them
	$(BIN)/python -m pytest -n 2 -m "long or hypothesis"

test-random: $(DEV) ## run the tests and the doctests in a random order (SEED=1)
	$(BIN)/python -m pytest -n 2 -p randomly --randomly-seed=$(or $(SEED),1) tests optlaws

wheel: $(DEV) ## build the wheel into dist
	$(BIN)/python -m hatchling build --target wheel --directory dist

check-wheel: $(DEV) ## run the first page from a wheel in new environments (PYTHONS="3.11 3.12", LOWEST=1)
	$(BIN)/python -m tests.check_wheel $(if $(LOWEST),--lowest) $(PYTHONS)

mutants: $(DEV) ## change the core here and there and see whether the tests notice (some 15 minutes)
	$(BIN)/python -m tests.mutants

lint: $(DEV) ## check style, formatting and types
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy

format: $(DEV) ## format the code and mend what can be mended
	$(BIN)/ruff format
	$(BIN)/ruff check --fix

docs: $(DEV) ## build the documentation into docs/_build/html (THEME=basic)
	$(BIN)/python -m sphinx -b html -W --keep-going -n -E -q $(if $(THEME),-D html_theme=$(THEME)) docs docs/_build/html

bench: $(DEV) ## run the benchmarks
	$(BIN)/python -m tests.bench

results: $(RUN) ## regenerate results/ from every problem file
	@set -e; for problem in $(PROBLEMS); do echo "optlaws run $$problem"; $(BIN)/optlaws run --force "$$problem"; done

# A run leaves every file that says the same as it is, but those that a machine follows, in which each digit counts.
check-results: $(DEV) ## run every problem file on a copy of results/ and see that nothing in it changes
	$(BIN)/python -m tests.check_results $(UNSTEADY)

check-proofs: $(DEV) ## check the proofs of results/ with optlaws verify and with the program in JavaScript (EACH=4)
	$(BIN)/python -m tests.check_proofs $(if $(EACH),--each $(EACH))

constraints: $(BIN)/python ## resolve every dependency again into constraints.txt (needs uv)
	@test -n "$(UV)" || { echo "make constraints needs uv" >&2; exit 1; }
	$(UV) pip compile pyproject.toml --all-extras --universal --python-version 3.11 --upgrade --quiet \
		--no-header --no-annotate --no-emit-index-url --no-emit-find-links --output-file constraints.txt

clean: ## remove everything that can be made again, the environment included
	rm -rf $(VENV) build dist docs/_build docs/gallery .mypy_cache .pytest_cache .ruff_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

$(BIN)/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null || { \
		echo "optlaws needs Python 3.11 or newer; $(PYTHON) is $$($(PYTHON) --version 2>&1)." >&2; \
		echo "Name another one: make PYTHON=python3.12 ..." >&2; exit 1; }
	@$(PYTHON) -m venv $(VENV) || { rm -rf $(VENV); \
		echo "$(PYTHON) cannot make virtual environments (on Debian and Ubuntu: install python3-venv)." >&2; exit 1; }

$(RUN): pyproject.toml constraints.txt | $(BIN)/python
	@echo "installing optlaws into $(VENV)"
	@$(call install,.)
	@touch $@

$(DEV): pyproject.toml constraints.txt | $(BIN)/python
	@echo "installing optlaws and its development tools into $(VENV)"
	@$(call install,'.[dev]')
	@touch $(RUN) $@
