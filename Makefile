# make demo    build, install, run the paper's two cylinders, and report on them
# make test    every test: Rust, Python, examples
# make check   format, lints, types, spelling
# make bench   timings (see benchmarks/README.md)
# make c       the library for C, C++ and Fortran, into PREFIX (target/c)
# make docs    the documentation site, site/index.html
# make release-check  what can be tried here of a release: sdist, wheel, crates (docs/making-a-release.md)
# make validate  long validations; rewrites docs/validation.md, says which numbers of the pages drifted

PYTHON ?= python3
PYTHON_SOURCES := python tests examples benchmarks docs tools
VENV := .venv
BIN := $(VENV)/bin
# All that a wheel is made of: templates and the assets of the report too.
SOURCES := $(shell find crates python -type f ! -name '*.pyc') \
	Cargo.toml Cargo.lock pyproject.toml README.md THIRD-PARTY-NOTICES.txt

.PHONY: demo test check bench c docs release-check validate clean

demo: $(VENV)/installed
	$(BIN)/carom run examples/two_cylinders.toml --out results/two_cylinders --set output.report=true --force

# Ranks that wait keep their cores: beside other tests they take twenty times as long.
test: $(VENV)/installed-dev
	$(BIN)/python tools/get_browser.py
	cargo test --release --locked --workspace --tests
	cargo test --release --locked --workspace --doc
	CAROM_C_BUILT_WITH=--workspace $(MAKE) c
	$(BIN)/pytest tests/unit/ranks/test_ranks.py
	$(BIN)/pytest -n auto --dist worksteal --ignore tests/unit/ranks/test_ranks.py

# With Python 3.11 or later, which Sphinx wants, the site too: its pages and links, not its gallery.
check: $(VENV)/installed-docs
	cargo fmt --all --check
	cargo clippy --release --locked --workspace --all-targets -- -D warnings
	RUSTDOCFLAGS="-D warnings" cargo doc --release --locked --workspace --no-deps --quiet
	$(BIN)/ruff format --check $(PYTHON_SOURCES)
	$(BIN)/ruff check $(PYTHON_SOURCES)
	$(BIN)/mypy
	$(BIN)/python tools/make_fortran.py --check
	$(BIN)/python docs/make_case_file_reference.py --check
	$(BIN)/python docs/make_command_reference.py --check
	$(BIN)/python docs/make_messages.py --check
	$(BIN)/python docs/images/make_drawings.py --check
	$(BIN)/python tools/renew_vendored.py --check
	$(BIN)/python tools/make_notices.py --check
	$(BIN)/python tools/make_ledger.py --check
	$(BIN)/python tools/check_rooms.py
	$(BIN)/typos
	if [ -x $(BIN)/sphinx-build ]; then $(BIN)/sphinx-build -W --keep-going -q -t unexecuted -b html docs target/site; fi

# Warnings are errors. Runs the cases of the gallery, those again that have changed, and looks at every page in a browser.
docs: $(VENV)/installed-docs
	$(BIN)/sphinx-build -W --keep-going -q -b html docs site
	$(BIN)/python tools/check_site.py site

PREFIX ?= target/c

c:
	sh crates/carom-c/install/install.sh "$(DESTDIR)$(PREFIX)"

bench:
	cargo bench --locked --package carom

# In environments of its own: a wheel is tried as those have it who install it.
release-check:
	$(PYTHON) tools/release_check.py

validate: $(VENV)/installed-dev
	$(BIN)/python benchmarks/validate.py
	$(BIN)/python benchmarks/fuzz
	CAROM_KILLS=500 $(BIN)/pytest tests/unit/running/test_restart.py -k killed
	CAROM_LONG=1 $(BIN)/pytest -m long
	$(BIN)/python benchmarks/claims

$(BIN)/python:
	$(PYTHON) -c 'import sys; sys.exit("carom needs Python 3.10 or later") if sys.version_info < (3, 10) else None'
	$(PYTHON) -m venv $(VENV)

# The wheel in release mode. pip builds in place, so the second build reuses the first one's objects.
$(VENV)/installed: $(BIN)/python $(SOURCES)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check .
	touch $@

$(VENV)/installed-dev: $(BIN)/python $(SOURCES)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check '.[dev]'
	touch $@ $(VENV)/installed

$(VENV)/installed-docs: $(BIN)/python $(SOURCES)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check '.[dev,docs]'
	touch $@ $(VENV)/installed-dev $(VENV)/installed

clean:
	rm -rf $(VENV) target results site docs/api-pages docs/gallery-pages
