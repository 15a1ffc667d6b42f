# Everything on a machine with nothing but Python 3.11 or 3.12, ROS 2 wheels included.
# On a ROS 2 machine use colcon instead (README).
#
#   make demo  [ARGS='--scenario ...']   simulator and tracker as two processes; Ctrl-C ends both
#   make test  [ARGS='-k gate']          the fast tests
#   make check                           ruff, mypy and the fast tests: what CI runs
#   make slow                            the slow tests
#   make clean                           removes .venv, caches and colcon's folders
#
# PYTHON=/path/to/python3.11 chooses the interpreter of .venv.

PYTHON ?=
export PYTHON

BIN := .venv/bin
DESCRIPTION := setup.py setup.cfg pyproject.toml package.xml .ci/setup
# One stamp for each choice of interpreter: asking for another one makes .venv anew.
INSTALLED := .venv/.installed$(addprefix -,$(notdir $(PYTHON)))
TOOLS := $(INSTALLED)-dev

.PHONY: demo test check slow clean

demo: $(INSTALLED)
	@exec $(BIN)/python .ci/foreground.py $(BIN)/marine_tracker demo $(ARGS)

# Arithmetic on all processors, then the nodes by themselves, which run in real time. Code 5: ARGS
# leaves no test in this half.
test: $(INSTALLED)
	$(BIN)/python -m pytest -m 'not slow and not nodes' -n auto --maxprocesses 4 --dist loadfile \
	    $(ARGS) || [ $$? = 5 ]
	$(BIN)/python -m pytest -m 'not slow and nodes' $(ARGS) || [ $$? = 5 ]

check: $(TOOLS)
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	@$(MAKE) --no-print-directory test

slow: $(INSTALLED)
	$(BIN)/python -m pytest -m slow $(ARGS)

$(INSTALLED): $(DESCRIPTION)
	@.ci/setup ros,test,parallel,plot,bench
	@touch $@

$(TOOLS): $(INSTALLED)
	@.ci/setup ros,test,parallel,plot,bench,dev
	@touch $@

clean:
	rm -rf .venv build install log *.egg-info .mypy_cache .pytest_cache .ruff_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
