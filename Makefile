# The two commands of the README: `make demo` and `make test`. Everything here is a short way to say cmake, ctest or a script of scripts/.
#
#   make build   the program, at build/karcher
#   make demo    build it and bend a Klein bottle
#   make test    build and run all tests
#   make fuzz    run the fuzzer of every reader for FUZZ_TIME=60 seconds each
#   make bench   run the benchmarks: BENCH_FILTER=regular-expression, BENCH_OUT=results.json
#   make gallery make the picture of every example
#   make check   format and dependency rules of the sources
#   make format  format the C++ files
#
# BUILD=debug, sanitize or narrow takes another preset of CMakePresets.json (and another directory, e.g. build-debug);
# CMAKE_ARGS=-DKARCHER_WERROR=ON adds options; JOBS=N sets the number of compilers at a time.

BUILD ?= release
JOBS ?= $(shell nproc)
CMAKE_ARGS ?=
FUZZ_TIME ?= 60
BENCH_FILTER ?= .
BENCH_OUT ?=

directory := $(if $(filter release,$(BUILD)),build,build-$(BUILD))
# A directory keeps the generator it was made with; a new one takes Ninja if there is one (asked when the recipe runs, since the packages may bring it).
# What is built for its own sake needs no GoogleTest, so a new directory has no tests until `make test` asks for them.
configure = cmake --preset $(BUILD) $(if $(wildcard $(directory)/CMakeCache.txt),,$(if $(shell command -v ninja),-G Ninja) -DKARCHER_TESTS=OFF)
compile = cmake --build $(directory) --parallel $(JOBS)

.PHONY: build demo test fuzz fuzzers bench gallery check format

build:
	@scripts/install_packages.sh build
	$(configure) $(CMAKE_ARGS)
	$(compile) --target karcher_program

demo: build
	@scripts/demo.sh $(directory)/karcher

test:
	@scripts/install_packages.sh build test
	$(configure) -DKARCHER_TESTS=ON $(CMAKE_ARGS)
	$(compile)
	ctest --test-dir $(directory) --output-on-failure --parallel $(JOBS)

# Always with sanitizers; beside the sanitized tests, if they are there, only the fuzzers themselves are left to build.
fuzz:
	@scripts/install_packages.sh build fuzz
	@$(MAKE) --no-print-directory fuzzers BUILD=sanitize

fuzzers:
	$(configure) -DKARCHER_FUZZ=ON $(CMAKE_ARGS)
	$(compile) --target karcher_fuzz
	@scripts/fuzz.sh $(directory) $(FUZZ_TIME)

bench:
	@scripts/install_packages.sh build bench
	$(configure) -DKARCHER_BENCH=ON $(CMAKE_ARGS)
	$(compile) --target karcher_bench
	$(directory)/bench/karcher_bench --benchmark_filter='$(BENCH_FILTER)' \
	  $(if $(BENCH_OUT),--benchmark_out='$(BENCH_OUT)' --benchmark_out_format=json)

gallery: build
	@scripts/install_packages.sh viewer
	@scripts/gallery.sh $(directory)/karcher

check:
	@scripts/install_packages.sh check
	@scripts/check_format.sh
	@scripts/check_dependencies.py --self-test
	@scripts/check_dependencies.py
	@scripts/check_documents.py
	@scripts/planted_faults.py --check

format:
	@scripts/install_packages.sh check
	@scripts/check_format.sh --fix
