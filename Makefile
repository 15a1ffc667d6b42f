# Everything on a machine with nothing but Python 3.11 or 3.12, ROS 2 wheels included.
# On a ROS 2 machine use colcon instead (README).
#
#   make demo  [ARGS='--scenario ...']   simulator and tracker as two processes; Ctrl-C ends both
#   make test  [ARGS='-k gate']          the fast tests
#   make check                           ruff, mypy, API pages and the fast tests: what CI runs
#   make api                             pages from the docstrings, in build/api
#   make slow                            the slow tests
#   make fuzz                            46,000 broken files and messages, the same ones each time
#   make clean                           removes .venv, caches and colcon's folders
#
# PYTHON=/path/to/python3.11 chooses the interpreter of .venv.

PYTHON ?=
export PYTHON
# Bytecode is kept, even where the environment says otherwise: the tests start hundreds of processes.
export PYTHONDONTWRITEBYTECODE :=

BIN := .venv/bin
DESCRIPTION := setup.py setup.cfg pyproject.toml package.xml Makefile .ci/setup
# What each target needs, the extras of setup.py. Every one has more than the one before.
FOR_DEMO := ros,display,record
FOR_TEST := $(FOR_DEMO),top,test,parallel,plot,bench,cluster,nmea2000
FOR_CHECK := $(FOR_TEST),dev
# A stamp for each, and for each choice of interpreter: asking for another one makes .venv anew.
CHOICE := $(addprefix -,$(notdir $(PYTHON)))
DEMO := .venv/.for-demo$(CHOICE)
TEST := .venv/.for-test$(CHOICE)
CHECK := .venv/.for-check$(CHOICE)

.PHONY: demo test nodes arithmetic check types api slow fuzz clean

demo: $(DEMO)
	@exec $(BIN)/python .ci/foreground.py $(BIN)/marine_tracker demo $(ARGS)

# Two halves side by side: the nodes, which run in real time and mostly wait, three files at a time; the
# arithmetic in the time that they leave, its output at its end.
test: $(TEST)
	@$(MAKE) --no-print-directory --jobs=2 --keep-going --output-sync=target nodes arithmetic

# Code 5: ARGS leaves no test in this half. A `+` line is not held back.
nodes:
	+@$(BIN)/python -m pytest -o testpaths=test/nodes -m 'not slow and not fuzz and nodes' -n 3 \
	    --dist loadfile $(ARGS) || [ $$? = 5 ]

arithmetic:
	@nice -n 19 $(BIN)/python -m pytest --ignore=test/nodes -m 'not slow and not fuzz and not nodes' \
	    -n auto --maxprocesses 4 --dist loadfile $(ARGS) || [ $$? = 5 ]

check: $(CHECK)
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	@$(MAKE) --no-print-directory --jobs=3 --keep-going --output-sync=target nodes arithmetic types api

types:
	nice -n 19 $(BIN)/mypy

api: $(CHECK)
	nice -n 19 $(BIN)/python doc/api/build.py build/api

slow: $(TEST)
	$(BIN)/python -m pytest -m slow $(ARGS)

fuzz: $(TEST)
	$(BIN)/python -m pytest -m fuzz -s $(ARGS)

$(DEMO): $(DESCRIPTION)
	@.ci/setup $(FOR_DEMO)
	@touch $@

$(TEST): $(DESCRIPTION)
	@.ci/setup $(FOR_TEST)
	@touch $(DEMO) $@

$(CHECK): $(DESCRIPTION)
	@.ci/setup $(FOR_CHECK)
	@touch $(DEMO) $(TEST) $@

clean:
	rm -rf .venv build install log *.egg-info .mypy_cache .pytest_cache .ruff_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
