# What people and CI do with the project; `make` alone lists it.
JOBS ?= $(shell nproc)
FOLDERS := $(wildcard accuracy apps calib core datasets servo tests)
SOURCES = $(shell find $(FOLDERS) -name '*.h' -o -name '*.cpp')

# ccache stores what is compiled with precompiled headers only if told so, and shares it between clones of the project
# only if it may disregard where they are.
export CCACHE_SLOPPINESS := pch_defines,time_macros
export CCACHE_BASEDIR := $(CURDIR)
export CCACHE_NOHASHDIR := true

.DEFAULT_GOAL := help
.PHONY: help demo test bench reproduction sanitize format check-format tidy clean packages packages-for-checks

help: ## list the targets
	@sed -n 's/^\([a-z-]*\):.*## /\1\t/p' $(MAKEFILE_LIST) | expand -t 16

demo: packages ## on a simulated rig: hold a session, calibrate, judge, servo; show the reports
	cmake --preset release
	cmake --build --preset release --parallel $(JOBS) --target legible
	scripts/demo.sh

test: packages ## build everything, run every test
	cmake --preset release
	cmake --build --preset release --parallel $(JOBS)
	ctest --preset release --parallel $(JOBS) --no-tests=error

bench: packages ## run the benchmarks: tables, and build/bench/*.json
	cmake --preset release
	cmake --build --preset release --parallel $(JOBS) --target tests/bench/all
	scripts/run_benchmarks.sh

reproduction: packages ## servo as the paper did: the tables and figures of docs/reproduction.md
	cmake --preset release
	cmake --build --preset release --parallel $(JOBS) --target legible tests/reproduction/all
	scripts/run_reproduction.sh

sanitize: packages ## run the unit tests under AddressSanitizer and UndefinedBehaviorSanitizer
	cmake --preset sanitize
	cmake --build --preset sanitize --parallel $(JOBS)
	ctest --preset sanitize --parallel $(JOBS) --no-tests=error

format: packages-for-checks ## lay the sources out
	clang-format -i $(SOURCES)

check-format: packages-for-checks ## say where the layout is not clang-format's
	clang-format --dry-run --Werror $(SOURCES)

tidy: packages-for-checks ## run clang-tidy over all sources, or those changed SINCE=<commit>
	scripts/run_clang_tidy.sh $(if $(SINCE),--since $(SINCE))

clean: ## remove everything that was built
	rm -rf build

packages:
	@scripts/install_dependencies.sh

packages-for-checks:
	@scripts/install_dependencies.sh --checks
