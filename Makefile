# The short way in; everything is plain CMake underneath (CMakePresets.json).
PRESET ?= release
PREFIX ?= /usr/local
SCENE  ?= scenes/platonic.json
CMAKE_ARGS ?=
# no: take the machine as it is, install no packages
SETUP  ?= yes

BUILD := build/$(PRESET)
NAME  := $(basename $(notdir $(SCENE)))

# $(call setup,LISTS): the Debian packages of these lists; $(call configure,PRESET)
setup = $(if $(filter no,$(SETUP)),@true,@cmake/install-packages $(1))
configure = @cmake/configure $(1) $(CMAKE_ARGS)

.DEFAULT_GOAL := help
.PHONY: help render build test test-asan bench golden install cuda-toolkit clean

help: ## this list
	@echo 'make TARGET [PRESET=release|debug|asan] [SETUP=no] [CMAKE_ARGS=...]'
	@sed -n 's/^\([a-z-]*\):.*## \(.*\)/  \1\t\2/p' $(MAKEFILE_LIST) | expand -t 16

render: ## build the renderer and render SCENE (scenes/platonic.json) to out/
	$(call setup,packages.txt)
	$(call configure,$(PRESET))
	@cmake --build $(BUILD) --target render
	@mkdir -p out
	$(BUILD)/bin/render $(SCENE) --backend embree -o out/$(NAME).exr --preview out/$(NAME).png

build: ## build everything: libraries, programs, tests, benchmarks
	$(call setup,packages.txt)
	$(call configure,$(PRESET))
	@cmake --build $(BUILD)

test: build ## build everything and run the tests
	ctest --test-dir $(BUILD) --output-on-failure -j2

test-asan: ## the tests under the address and undefined-behaviour sanitizers
	@$(MAKE) --no-print-directory test PRESET=asan

bench: ## build the benchmarks and run them; JSON into out/bench
	$(call setup,packages.txt bench/packages.txt)
	$(call configure,$(PRESET))
	@cmake --build $(BUILD)
	bench/run $(BUILD)

golden: ## render the golden images again and say what changed
	$(call setup,packages.txt)
	$(call configure,$(PRESET))
	@cmake --build $(BUILD) --target make_golden
	$(BUILD)/bin/make_golden golden

install: ## install programs, libraries, headers and the CMake package under PREFIX (/usr/local)
	$(call setup,packages.txt)
	$(call configure,$(PRESET))
	@cmake --build $(BUILD) --target installed
	cmake --install $(BUILD) --prefix $(PREFIX)

cuda-toolkit: ## put nvcc from PyPI into .cuda/, for machines without a CUDA toolkit
	@cmake/install-cuda-toolkit

clean: ## remove build/
	rm -rf build
