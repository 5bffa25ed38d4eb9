# make            builds stepc, lyrrun, lyrctl and lyrview into build/ (installs missing Debian packages first)
# make demo       slices the gearbox base, simulates the print, draws a layer and a page: all into demo/
# make test       builds and runs every test, on this machine's processor
# make test-emulated   those of what runs on a board, built for 64-bit and 32-bit ARM and run by qemu-user, but for the
#                 longest cases, into build-arm64/ and build-armhf/
# make test-bits  a million random bits of a large print flipped, one at a time: both readers find each
# make test-kernel     boots Debian's kernel in QEMU and prints there, on simulated lines: docs/kernel-test.md
# make test-kernel-pi  the same on QEMU's Raspberry Pi 3, with lyrrun built for it
# make sanitize   the same tests under the address and undefined-behaviour sanitizers, into build-sanitize/
# make tsan       what runs on a board under the thread sanitizer, into build-tsan/
# make test-klipper KLIPPER=checkout   both show pieces as G-code through Klipper's own batch mode (needs: tools/setup
#                 --klipper); docs/exports.md
# make board      only what a printer's board needs (lyrrun, lyrctl, lyrview), into build-board/
# make cross      the same (lyrctl without its page) for 64-bit and 32-bit ARM boards with Debian 12 or later, into build-arm64/ and build-armhf/
# make test-cross the same tests, and those of the file's checks, exports and imports
# make bench      speed beside OpenCASCADE's and PrusaSlicer's, into build-bench/ (needs: tools/setup --bench);
#                 LYR_BENCH_FILES=folder of STEP files to read
# make install    into PREFIX (default /usr/local)
# make clean      removes what the others made

BUILD  ?= build
PREFIX ?= /usr/local
JOBS   ?= $(shell nproc)
LYR_BENCH_FILES ?= fixtures/parts
LYR_BENCH_SET   = --set perimeters.count=3 --set infill.density=15% --set infill.pattern=grid
CONFIGURE = cmake -S . -B $(BUILD) -DCMAKE_BUILD_TYPE=Release
# One more than there are processors: some of them wait for most of their time.
CTEST   = ctest --output-on-failure -j $(shell expr $(JOBS) + 1)

.PHONY: all setup test-setup demo test test-bits test-kernel test-kernel-pi test-klipper sanitize tsan board cross \
        test-emulated test-cross bench install clean

all: setup
	$(CONFIGURE)
	cmake --build $(BUILD) -j $(JOBS) --target stepc lyrrun lyrctl lyrview lyr_format_c

setup:
	@tools/setup

test-setup:
	@tools/setup --test
	@tools/setup --gpiod2 $(BUILD)/gpiod2 || echo "setup: without libgpiod 2.x its tests are left out" >&2

demo: all
	@mkdir -p demo
	$(BUILD)/stepc fixtures/parts/gearbox_base.step -o demo/gearbox_base.lyr
	$(BUILD)/lyrrun demo/gearbox_base.lyr --simulate
	$(BUILD)/lyrview demo/gearbox_base.lyr --layer 36 --no-travel -o demo/layer-36.svg
	$(BUILD)/lyrview demo/gearbox_base.lyr -o demo/gearbox_base.html
	@echo "The picture: demo/layer-36.svg; the print, in a browser: demo/gearbox_base.html"

test: test-setup
	$(CONFIGURE)
	cmake --build $(BUILD) -j $(JOBS)
	cd $(BUILD) && $(CTEST)

test-bits: all
	cmake --build $(BUILD) -j $(JOBS) --target flipped_bits
	$(BUILD)/stepc fixtures/parts/lower_teeth.step -o $(BUILD)/lower_teeth.lyr
	$(BUILD)/flipped_bits $(BUILD)/lower_teeth.lyr

test-kernel: test-setup all
	cmake --build $(BUILD) -j $(JOBS) --target test_gpio
	tests/linux/sim/kernel $(BUILD)/linux
	tests/linux/sim/run $(BUILD) $(BUILD)/linux

test-kernel-pi: all
	@tools/setup --kernel-pi
	tests/linux/pi/kernel $(BUILD)/linux-pi
	tests/linux/pi/build $(BUILD)/linux-pi
	tests/linux/pi/run $(BUILD) $(BUILD)/linux-pi

test-klipper: all
	@mkdir -p build-klipper
	$(BUILD)/stepc fixtures/parts/gearbox_base.step -o build-klipper/gearbox.gcode --set gcode.flavor=klipper
	$(BUILD)/stepc fixtures/parts/gearbox_base.step -o build-klipper/absolute.gcode --set gcode.flavor=klipper \
	  --set gcode.extrusion=absolute --set travel.wipe=2
	$(BUILD)/stepc fixtures/parts/lower_teeth.step -o build-klipper/arch.gcode --set gcode.flavor=klipper \
	  --layer-height 0.1
	tools/check-klipper "$(KLIPPER)" build-klipper/gearbox.gcode build-klipper/absolute.gcode build-klipper/arch.gcode

sanitize: test-setup
	cmake -S . -B build-sanitize -DCMAKE_BUILD_TYPE=RelWithDebInfo -DLYR_SANITIZE=ON
	cmake --build build-sanitize -j $(JOBS)
	cd build-sanitize && $(CTEST)

tsan: test-setup
	cmake -S . -B build-tsan -DCMAKE_BUILD_TYPE=RelWithDebInfo -DLYR_KERNEL=OFF -DLYR_SANITIZE=thread
	cmake --build build-tsan -j $(JOBS) --target board_tests
	cd build-tsan && $(CTEST) -L board

board: setup
	cmake -S . -B build-board -DCMAKE_BUILD_TYPE=Release -DLYR_KERNEL=OFF -DLYR_TESTS=OFF \
	  -DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON
	cmake --build build-board -j $(JOBS)

# The pattern's stem is Debian's name of the processor.
CROSS = arm64 armhf

cross: $(CROSS:%=cross-%)

cross-%:
	tools/cross $* build-$*
	cmake --build build-$* -j $(JOBS) --target lyrrun lyrctl lyrview

# Both at the same time, after what they are built with was fetched for one and then the other. A processor for which it
# cannot be had is no failure, and is told last.
test-emulated:
	@ready=""; without=""; \
	for arch in $(CROSS); do \
	  if tools/setup --cross $$arch build-$$arch/sysroot; then ready="$$ready test-emulated-$$arch"; \
	  else without="$$without $$arch"; fi; \
	done; \
	[ -z "$$ready" ] || $(MAKE) --no-print-directory -j $(JOBS) -O $$ready || exit 1; \
	[ -z "$$without" ] || echo "test-emulated: NOT RUN, without a compiler or the board's libraries:$$without" >&2

test-emulated-%:
	tests/emulated/run $* build-$* $$((($(JOBS) + 1) / 2))

test-cross: $(CROSS:%=test-cross-%)

# Programs that start others need an emulator that the kernel knows of; test_apps is left to "make test".
test-cross-%: cross-%
	cmake --build build-$* -j $(JOBS) --target board_tests
	cd build-$* && $(CTEST) -L board

bench: setup
	cmake -S . -B build-bench -DCMAKE_BUILD_TYPE=Release -DLYR_BENCH=ON -DLYR_TESTS=OFF
	cmake --build build-bench -j $(JOBS) --target bench_micro bench_compare bench_lyr stepc
	build-bench/bench_micro
	build-bench/stepc fixtures/parts/gearbox_base.step -o build-bench/gearbox_base.lyr --layer-height 0.2 $(LYR_BENCH_SET)
	build-bench/stepc fixtures/parts/lower_teeth.step -o build-bench/lower_teeth.lyr --layer-height 0.1 $(LYR_BENCH_SET)
	build-bench/bench_lyr build-bench/gearbox_base.lyr build-bench/lower_teeth.lyr
	build-bench/bench_compare --files "$(LYR_BENCH_FILES)"

install: all
	cmake --install $(BUILD) --prefix $(PREFIX)

clean:
	rm -rf build build-sanitize build-tsan build-board build-arm64 build-armhf build-bench build-klipper demo
