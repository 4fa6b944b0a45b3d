# The short way in; everything is plain CMake underneath (CMakePresets.json).
PRESET ?= release
PREFIX ?= /usr/local
SCENE  ?= scenes/platonic.json
CMAKE_ARGS ?=
# of `make test` and `make test-quick`: the tests whose names match this regular expression, as ctest -R takes it
TEST   ?=
# no: take the machine as it is, install no packages
SETUP  ?= yes

BUILD := build/$(PRESET)
NAME  := $(basename $(notdir $(SCENE)))

# $(call setup,LISTS): the Debian packages of these lists; $(call configure,PRESET)
setup = $(if $(filter no,$(SETUP)),@true,@cmake/install-packages $(1))
configure = @cmake/configure $(1) $(2) $(CMAKE_ARGS)

# before each line of ninja: steps that are done, of how many, and the seconds since it began
export NINJA_STATUS ?= [%f of %t, %e s] 

# which cmake/configure reads: yes compiles all kernels where there is no GPU, too
CUDA   ?=

.DEFAULT_GOAL := help
.PHONY: help render build test test-quick test-asan test-report test-clients fuzz lint check-all bench gpu-check golden docs install uninstall package wheel cuda-toolkit clean

help: ## this list
	@echo 'make TARGET [PRESET=release|release-all|debug|asan|fuzz|clang] [SETUP=no] [CMAKE_ARGS=...]'
	@sed -n 's/^\([a-z-]*\):.*## \(.*\)/  \1\t\2/p' $(MAKEFILE_LIST) | expand -t 16

render: ## build the renderer and render SCENE (scenes/platonic.json) to out/
	$(call setup,packages.txt:renderer)
	@[ -x $(BUILD)/bin/render ] || echo 'render: compiled once, which takes two to five minutes on two cores; lines count steps and seconds'
	$(call configure,--renderer $(PRESET))
	@cmake --build $(BUILD) --target render
	@mkdir -p out
	$(BUILD)/bin/render $(SCENE) --backend embree -o out/$(NAME).exr --preview out/$(NAME).png
	@echo 'The picture is out/$(NAME).png, its values are in out/$(NAME).exr. Next: make render SCENE=scenes/glass.json, or $(BUILD)/bin/render --help'

build: ## build libraries, programs, the Python package and tests
	$(call setup,packages.txt)
	@python/make-venv
	$(call configure,$(PRESET))
	@cmake --build $(BUILD)

# $(call run_tests,ARGUMENTS of ctest)
run_tests = tests/run $(BUILD) $(if $(TEST),-R '$(TEST)') $(1)

test: build ## build everything and run the tests; TEST=PATTERN: those whose names match
	$(call run_tests)

test-quick: ## build and run the quick tests alone
	$(call setup,packages.txt)
	@python/make-venv
	$(call configure,$(PRESET))
	@cmake --build $(BUILD) --target quick_tests
	$(call run_tests,-L quick)

test-asan: ## the tests under the address and undefined-behaviour sanitizers
	@$(MAKE) --no-print-directory test PRESET=asan

# of `make fuzz`: a target, a source of tests/fuzz (all, if none is named), and for how long each searches
TARGET ?=
SECONDS ?= 60

fuzz: ## search for inputs that break a reader: TARGET=ply SECONDS=60 (the targets: tests/fuzz/*.cpp; all by default); what it finds and learns into build/fuzz/found
	$(call setup,packages.txt tests/lint-packages.txt)
	tests/fuzz/search $(SECONDS) build/fuzz $(TARGET)

lint: ## check the format of all sources, and libcore, apps/common and apps/render by clang-tidy
	$(call setup,packages.txt tests/lint-packages.txt)
	$(call configure,clang)
	tests/lint build/clang

check-all: lint ## before a release: lint, all tests, the benchmarks built, the quick tests under sanitizers and by clang, ten seconds of fuzzing each reader
	@$(MAKE) --no-print-directory test
	@cmake --build $(BUILD) --target benchmarks
	@$(MAKE) --no-print-directory test-quick PRESET=asan CMAKE_ARGS='$(CMAKE_ARGS) -DCISTULA_WITH_CUDA=OFF'
	@$(MAKE) --no-print-directory test-quick PRESET=clang
	@$(MAKE) --no-print-directory fuzz SECONDS=10

test-report: ## measure a small report, open it and a suite's page in headless Chromium and look for what is wrong; screenshots into out/report
	$(call setup,packages.txt tests/report-packages.txt)
	@python/make-venv
	$(call configure,$(PRESET))
	@cmake --build $(BUILD) --target python render-compare
	@mkdir -p out/report
	PYTHONPATH=$(BUILD)/python build/python/bin/python -m cistula report scenes/benchmark.json scenes/platonic.json --quick --res 96x54 --scaling -o out/report/small.html
	tests/report-check out/report/small.html $(wildcard docs/report/*.html) --screenshots out/report
	tests/check_suite_page.sh . $(BUILD) out/report

# Pythons of build/clients, filled by pip from the lists in tests/clients
define client_pythons
	@for name in tools blender; do \
	    [ -x build/clients/$$name/bin/pip ] || python3 -m venv build/clients/$$name && \
	    build/clients/$$name/bin/pip install -q --disable-pip-version-check -r tests/clients/$$name.txt || exit; \
	done
endef

test-clients: ## have OpenEXR's Python, OpenImageIO with OpenColorIO, ffmpeg, GIMP and Blender read what render writes; Python 3.11; frames into out/clients
	$(call setup,packages.txt:renderer tests/clients/packages.txt)
	$(call configure,--renderer $(PRESET))
	@cmake --build $(BUILD) --target render
	$(client_pythons)
	tests/clients/check $(BUILD)/bin build/clients out/clients

bench: ## build the benchmarks and run them; bars and records into out/bench
	$(call setup,packages.txt bench/packages.txt)
	$(call configure,$(PRESET))
	@cmake --build $(BUILD) --target render benchmarks
	bench/run $(BUILD)

gpu-check: export CUDA = yes
gpu-check: ## on a machine with a GPU: compare it with the CPU bit for bit, and time it; bars and records into out/bench
	$(call setup,packages.txt)
	$(call configure,$(PRESET))
	@cmake --build $(BUILD) --target help | grep -qw gpu_check || \
	    { echo 'gpu-check: this build has no CUDA backend (the configuration says why; make cuda-toolkit fetches nvcc)' >&2; exit 4; }
	@cmake --build $(BUILD) --target gpu_check seed_baseline render render-compare
	@! cmake --build $(BUILD) --target help | grep -qw gpu_check_fast || cmake --build $(BUILD) --target gpu_check_fast
	bench/gpu-check $(BUILD)

golden: ## record the golden images that differ and say what changed
	$(call setup,packages.txt)
	$(call configure,$(PRESET))
	@cmake --build $(BUILD) --target render-compare
	$(BUILD)/bin/render-compare suite golden --backend embree --update

wheel: ## make a wheel of the Python package, with all libraries that it needs, and an sdist, into out/wheel; CUDA=yes: with kernels
	$(call setup,packages.txt)
	@python/make-venv
	@python/make-wheel

docs: ## the reference of libcore/cistula and of the Renderer interface, into out/docs
	$(call setup,docs/packages.txt)
	@mkdir -p out
	doxygen docs/Doxyfile

# $(build_installed): what `make install` and `make package` copy; CMake looks again for help2man, which may be new
define build_installed
	$(call setup,packages.txt cmake/packaging-packages.txt)
	$(call configure,$(PRESET))
	@cmake -B $(BUILD) >/dev/null
	@cmake --build $(BUILD) --target installed
endef

install package: export CUDA = yes

install: ## install programs, manuals, libraries, headers, scenes, documents and the CMake package under PREFIX (/usr/local)
	$(build_installed)
	cmake --install $(BUILD) --prefix $(abspath $(PREFIX))
	@install -D -m 644 $(BUILD)/install_manifest.txt $(DESTDIR)$(abspath $(PREFIX))/share/cistula/installed-files.txt

uninstall: ## remove what `make install` put under PREFIX (/usr/local)
	@DESTDIR=$(DESTDIR) cmake/uninstall $(abspath $(PREFIX))

package: ## make a Debian package for the release of Debian that this is, into out/package
	$(build_installed)
	cpack --config $(BUILD)/CPackConfig.cmake -B out/package

cuda-toolkit: ## put nvcc from PyPI into .cuda/, for machines without a CUDA toolkit
	@cmake/install-cuda-toolkit

clean: ## remove build/
	rm -rf build
