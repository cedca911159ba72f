# mpm.h - the library is its headers; this builds the examples, the tests and the figures, installs and packs.
# `make help` lists the targets: it prints the words behind "##" in this file.

VERSION := $(shell sed -n 's/^.define MPM_VERSION "\(.*\)"/\1/p' mpm.h)

# Contraction off: the same source gives the same bits with and without fused multiply-add.
NATIVE := $(shell echo 'int x;' | $(CC) -march=native -xc -c -o /dev/null - 2>/dev/null && echo -march=native)
CFLAGS ?= -O3 $(NATIVE) -ffp-contract=off -fno-math-errno -fno-trapping-math
# What is linked with the library is compiled quickly; it holds at any level.
TESTFLAGS ?= -O2 -ffp-contract=off
STRICT  = -std=c99 -pedantic -Wall -Wextra -Wconversion -Wshadow
INCLUDE = -I. -Iexamples -Iexamples/studies -Itests
# The compiler notes beside each program which headers it includes: it is built again when one of these changes.
NOTE    = -MMD -MP -MF $@.d -MT $@
JOBS   ?= 2
PREFIX ?= /usr/local
MAKEFLAGS += -r

HEADERS  = $(wildcard mpm*.h)
EXAMPLES = $(patsubst examples/%.c,build/%,$(wildcard examples/*.c))
STUDIES  = $(patsubst examples/studies/%.c,build/%,$(wildcard examples/studies/*.c)) build/reproduction
# A program of several files.
PARTS    = $(patsubst examples/studies/%.c,build/parts/%.o,$(wildcard examples/studies/reproduction/*.c))
TESTS    = $(patsubst tests/%.c,build/tests/%,$(wildcard tests/[0-9]*.c))
# Tests that run programs, or read files of them, which are in double whatever the test is: no twin in float.
DOUBLES  = $(addprefix tests/,12_material_program.c 54_spray_example.c 62_studies.c 65_log.c 67_history.c 72_method.c \
           75_ladder.c)
FLOATS   = $(patsubst tests/%.c,build/tests/%_f32,$(filter-out $(DOUBLES),$(wildcard tests/[0-9]*.c)))
SCRIPTS  = tests/compile/run.sh $(sort $(wildcard tests/[0-9]*.sh))
VERIFY   = $(patsubst tests/verify/%.c,build/verify/%,$(sort $(wildcard tests/verify/*.c)))
BENCH    = $(patsubst bench/%.c,build/bench/%,$(wildcard bench/*.c))

all: $(EXAMPLES) $(STUDIES) $(TESTS) $(FLOATS) $(BENCH) ## everything into build/ (what a plain `make` does)

help: ## this list
	@awk -F ':.*## ' '/^[a-z0-9-]+:.*## / { printf "make %-14s %s\n", $$1, $$2 }' Makefile

run: build/impact ## the main job: an aluminium particle hits an aluminium plate at 810 m/s
	build/impact --out build/impact-out

test: $(EXAMPLES) $(STUDIES) $(TESTS) $(FLOATS) ## every test, double and float, the compile tests, the packages; JOBS=2 at a time
	@sh tests/run.sh $(JOBS) "$(CC)" $(SCRIPTS) $(TESTS)

# mpm_hdf5.h writes files of HDF5 if the library is compiled for it: `make HDF5=1`, here and in all that is linked with
# it. Where this changes, the library is compiled again. pkg-config knows hdf5-serial on Debian, hdf5 elsewhere.
HDF5_ASK = $(shell pkg-config $(1) hdf5-serial 2>/dev/null || pkg-config $(1) hdf5 2>/dev/null)
WITH_HDF5 = -DMPM_HDF5 $(patsubst -I%,-isystem %,$(call HDF5_ASK,--cflags))
HDF5_LIBS = $(call HDF5_ASK,--libs)
ifdef HDF5
override LDFLAGS += $(HDF5_LIBS)
endif
build/hdf5.on build/hdf5.off:
	@mkdir -p build
	@rm -f build/hdf5.on build/hdf5.off && touch $@

# The library is compiled once, in double and in float, and linked with everything that MPM_COMPILED keeps from
# bringing its own. bench/step brings its own: its times are compared with those of earlier versions.
COMPILED = -DMPM_COMPILED $(TESTFLAGS)
build/mpm.o: mpm.c build/hdf5.$(if $(HDF5),on,off)
	@mkdir -p build
	$(CC) $(STRICT) $(CFLAGS) $(if $(HDF5),$(WITH_HDF5)) $(NOTE) -c $< -o $@

build/mpm_f32.o: mpm.c
	@mkdir -p build
	$(CC) $(STRICT) $(CFLAGS) -DMPM_FLOAT $(NOTE) -c $< -o $@

# The ladder is compiled as its files say: each is whole, and takes a second or two at any level.
LADDER = $(filter build/0%,$(EXAMPLES))
$(LADDER): build/%: examples/%.c
	@mkdir -p build
	$(CC) $(STRICT) $(TESTFLAGS) $(INCLUDE) $(NOTE) $< -o $@ $(LDFLAGS) -lm

$(filter-out $(LADDER),$(EXAMPLES)): build/%: examples/%.c build/mpm.o
	$(CC) $(STRICT) $(COMPILED) $(INCLUDE) $(NOTE) $< build/mpm.o -o $@ $(LDFLAGS) -lm

$(filter-out build/reproduction,$(STUDIES)): build/%: examples/studies/%.c build/mpm.o
	$(CC) $(STRICT) $(COMPILED) $(INCLUDE) $(NOTE) $< build/mpm.o -o $@ $(LDFLAGS) -lm

$(PARTS): build/parts/%.o: examples/studies/%.c
	@mkdir -p $(@D)
	$(CC) $(STRICT) $(COMPILED) $(INCLUDE) $(NOTE) -c $< -o $@

build/reproduction: $(PARTS) build/mpm.o
	$(CC) $(PARTS) build/mpm.o -o $@ $(LDFLAGS) -lm

# 40_io stands between its own copy of mpm_io.h and the system: it brings the library itself.
OWN = build/tests/40_io build/tests/40_io_f32
build/tests/40_io: tests/40_io.c
	@mkdir -p build/tests
	$(CC) $(STRICT) $(TESTFLAGS) $(INCLUDE) $(NOTE) $< -o $@ $(LDFLAGS) -lm

build/tests/40_io_f32: tests/40_io.c
	@mkdir -p build/tests
	$(CC) $(STRICT) $(TESTFLAGS) -DMPM_FLOAT $(INCLUDE) $(NOTE) $< -o $@ $(LDFLAGS) -lm

$(filter-out $(OWN),$(FLOATS)): build/tests/%_f32: tests/%.c build/mpm_f32.o
	@mkdir -p build/tests
	$(CC) $(STRICT) $(COMPILED) -DMPM_FLOAT $(INCLUDE) $(NOTE) $< build/mpm_f32.o -o $@ $(LDFLAGS) -lm

$(filter-out $(OWN),$(TESTS)): build/tests/%: tests/%.c build/mpm.o
	@mkdir -p build/tests
	$(CC) $(STRICT) $(COMPILED) $(INCLUDE) $(NOTE) $< build/mpm.o -o $@ $(LDFLAGS) -lm

$(BENCH): build/bench/%: bench/%.c
	@mkdir -p build/bench
	$(CC) $(STRICT) $(CFLAGS) $(INCLUDE) $(NOTE) $< -o $@ $(LDFLAGS) -lm

$(VERIFY): build/verify/%: tests/verify/%.c build/mpm.o
	@mkdir -p build/verify
	$(CC) $(STRICT) $(COMPILED) $(INCLUDE) -Itests/verify $(NOTE) $< build/mpm.o -o $@ $(LDFLAGS) -lm

# What `make hdf5` runs, whether HDF5=1 or not.
build/mpm_hdf5.o: mpm.c
	@mkdir -p build
	$(CC) $(STRICT) $(CFLAGS) $(WITH_HDF5) $(NOTE) -c $< -o $@

build/impact_hdf5: examples/impact.c build/mpm_hdf5.o
	$(CC) $(STRICT) $(COMPILED) $(INCLUDE) $(NOTE) $< build/mpm_hdf5.o -o $@ $(LDFLAGS) $(HDF5_LIBS) -lm

build/many_particles_hdf5: examples/studies/many_particles.c build/mpm_hdf5.o
	$(CC) $(STRICT) $(COMPILED) $(INCLUDE) $(NOTE) $< build/mpm_hdf5.o -o $@ $(LDFLAGS) $(HDF5_LIBS) -lm

build/tests/hdf5/frames: tests/42_hdf5.c build/mpm_hdf5.o
	@mkdir -p build/tests/hdf5
	$(CC) $(STRICT) $(COMPILED) $(INCLUDE) $(NOTE) $< build/mpm_hdf5.o -o $@ $(LDFLAGS) $(HDF5_LIBS) -lm

build/tests/hdf5/append: tests/hdf5/append.c build/mpm_hdf5.o
	@mkdir -p build/tests/hdf5
	$(CC) $(STRICT) $(COMPILED) $(INCLUDE) $(NOTE) $< build/mpm_hdf5.o -o $@ $(LDFLAGS) $(HDF5_LIBS) -lm

-include $(wildcard build/*.d build/*/*.d build/*/*/*.d)
# The notes may name a source that has moved since: no reason to stop.
%.c: ;

# One section of docs/verification.md; finished sections are kept.
build/verify/%.md: build/verify/%
	$< >$@.part && mv $@.part $@

verify: $(VERIFY:=.md) ## the verification ladder again: writes docs/verification.md; resumable, `make -j2 verify`
	sh tests/verify/page.sh $(VERIFY:=.md) >docs/verification.md.part
	mv docs/verification.md.part docs/verification.md
	@grep -h '^[0-9]* rows' docs/verification.md

# The runs behind docs/reproduction.md and the README, and the numbers quoted there.
RIM = --material al-thesis --geometry axisymmetric --cell 0.7 --spacing 0.175 --dt-factor 0.2 --frames 1 --quiet
impacts: build/impact ## the impacts of docs/reproduction.md: bonded, unbonded, whole model, rim jet (6 minutes)
	build/impact --frames 0 --quiet --out build/bonded
	build/impact --frames 0 --quiet --out build/unbonded --bond none
	build/impact --frames 0 --quiet --out build/whole --symmetry full
	@grep -HE '"(pbcp_percent|v_rest_(mean|filtered)_m_s|eps_mean|temperature_max_K|energy_(error|unaccounted))"' \
		build/bonded/summary.json build/unbonded/summary.json build/whole/summary.json
	build/impact $(RIM) --diameter 38 --velocity 780 --substrate-diameter 63.3333 --substrate-height 12.6667 \
		--time 101.333 --out build/jet_38
	build/impact $(RIM) --diameter 45 --velocity 550 --substrate-diameter 75 --substrate-height 15 --time 120 \
		--out build/jet_45
	for d in 38 45; do cp build/jet_$$d/impact.png docs/data/jet_$$d.png.part && \
		mv docs/data/jet_$$d.png.part docs/data/jet_$$d.png || exit 1; done

# Writes its part of docs/reproduction.md, and docs/data; finished runs are kept in build/reproduction-out.
# The page in this repository is that of BUDGET=desk. DESK=crit,held runs these parts at the desk budget.
reproduction: BUDGET = quick
reproduction: build/reproduction ## source A's results again: an hour; BUDGET=desk: nine hours; full: days; resumable
	build/reproduction --budget $(BUDGET) --desk "$(DESK)"

# Writes docs/spray.md and docs/data; finished runs are kept in build/spray_study.log.
BUDGET ?= full
spray-study: build/spray_study ## source B's results again: a quarter of an hour, resumable; BUDGET=quick: less
	build/spray_study --budget $(BUDGET)

# Writes the tables of docs/prediction.md, and docs/data; finished runs are kept in build/predict.
POSITIONS ?= 4
predict: build/impact build/critical_velocity ## docs/prediction.md again: critical velocities by contact on surfaces; an hour and a half, resumable; POSITIONS=4
	sh examples/studies/prediction.sh $(POSITIONS) $(JOBS)

embedded: ## an impact on a Cortex-M4 under qemu beside the same one here (half a minute)
	@sh examples/embedded/run.sh "$(CC)"

# fuzz needs clang with libFuzzer; hard takes what it finds of tools and skips the others. CHECKS="gcc kill": these only.
SECONDS ?= 20
fuzz: ## random inputs for everything that reads or describes: SECONDS=20 for each target of tests/fuzz
	@CC="$(CC)" sh tests/fuzz/run.sh $(SECONDS) $(JOBS)

.PHONY: hdf5
hdf5: ## build/impact_hdf5 and many_particles_hdf5, which know --hdf5; h5py, VTK, ParaView read their files
	@sh tests/hdf5/run.sh "$(CC)" "$(MAKE)" "$(WITH_HDF5)" "$(HDF5_LIBS)"

KILLS ?= 200
hard: ## memory and disks that fail, kill -9, sanitizers, analysers, compilers: writes docs/quality.md; KILLS=200
	@sh tests/hard/run.sh $(KILLS) $(JOBS) $(CHECKS)

.PHONY: sweep-test
sweep-test: build/sweep build/impact build/critical_velocity build/calibrate ## build/sweep with workers killed; under make, xargs, GNU parallel, Slurm
	@sh tests/69_sweep.sh "$(CC)" 200
	@sh tests/sweep_engines.sh

# Without the tests whose work is done by programs, and without the long runs of 70_bits.
UNITS    = $(filter-out $(DOUBLES) tests/60_% tests/61_% tests/63_% tests/70_%,$(sort $(wildcard tests/[0-9]*.c)))
coverage: build/pull ## lines and branches of the headers that the unit tests reach: at least 98 % of the lines
	@sh tests/coverage.sh $(JOBS) $(UNITS)

bench: $(BENCH) build/bench_impact ## speed, as ratios measured in one run: writes docs/performance.md (3 minutes)
	@for b in $(BENCH); do $$b || exit 1; done
	@sh bench/performance.sh

# One run of bench/step takes half a minute; N of them for each of the two.
N ?= 5
bench-against: ## the speed of the step beside REV=<tag or commit>: N=5 runs of each in turns, ratio of medians
	@sh bench/against.sh $(or $(REV),$(error REV=<tag or commit>)) $(N) "$(CC)" $(CFLAGS)

.PHONY: api
api: ## the reference of all public names, from the headers' comments: build/api/index.html
	@sh packaging/api.sh build/api

# The commands stand in the page, so that it shows what is run.
.PHONY: gallery
gallery: build/impact build/taylor build/spray build/two_particles build/many_particles ## the pictures of docs/gallery.md again, by the commands there (two minutes)
	@mkdir -p build/gallery
	sed -n 's/^    //p' docs/gallery.md >build/gallery/commands.sh
	sh -eux build/gallery/commands.sh
	@sh tests/79_gallery.sh >build/gallery/checks || { grep '^not ok' build/gallery/checks; exit 1; }

.PHONY: report-page report-test
# The page of report.h: changes of web/report get into the programs by this.
report-page: ## after a change of web/report: puts it into examples/report_page.h
	sh web/report/embed.sh >examples/report_page.h.part && mv examples/report_page.h.part examples/report_page.h

report-test: build/impact build/critical_velocity ## report.html (of runs) in headless Chromium, with pictures of it in build/report-web
	@sh tests/web/report.sh

# MPI: a world cut into slabs, a rank each. Without mpicc there is nothing to build.
.PHONY: mpi
mpi: build/many_particles build/mpm.o ## examples/mpi with MPI, and its tests on up to four ranks (two minutes)
	@command -v mpicc >/dev/null && command -v mpirun >/dev/null || \
		{ echo "skip: mpicc or mpirun is not installed (libopenmpi-dev, openmpi-bin)"; exit 0; } && \
		mkdir -p build/mpi && mpicc $(STRICT) $(CFLAGS) -DMPM_COMPILED $(INCLUDE) -Iexamples/mpi examples/mpi/many_particles.c \
		build/mpm.o -o build/mpi/many_particles $(LDFLAGS) -lm && sh tests/mpi/run.sh

figures: ## the figures of docs/method.md
	@mkdir -p build
	$(CC) $(STRICT) $(CFLAGS) $(INCLUDE) docs/figures.c -o build/figures $(LDFLAGS) -lm
	build/figures

# The live page: the headers as WebAssembly, by a clang that can (Debian: clang lld wasi-libc
# libclang-rt-14-dev-wasm32). Its test compares it with build/impact, and needs node and Chromium.
WASM_CC  ?= clang
LIVE_PAGE = index.html live.css engine.js worker.js choices.js curves.js impact.js lesson.js live.js
build/web/live.wasm: web/live/live.c web/live/build.sh $(HEADERS) $(wildcard examples/*.h)
	@sh web/live/build.sh "$(WASM_CC)"

web: build/web/live.wasm ## the live page, which computes in a browser: build/web/index.html; WASM_CC=clang
	@mkdir -p build/web/data
	@cp $(addprefix web/live/,$(LIVE_PAGE)) build/web
	@cp docs/data/method_*.png build/web/data
	@awk -f web/live/page.awk docs/method.md >build/web/method.html.part
	@mv build/web/method.html.part build/web/method.html
	@echo "build/web/index.html: open it, or python3 -m http.server -d build/web"

live-test: build/impact build/tests/live_digits ## the live page in headless Chromium, and its numbers beside those of the desktop
	@sh tests/web/live.sh "$(MAKE)" "$(WASM_CC)"

build/tests/live_digits: tests/web/live_digits.c build/mpm.o
	@mkdir -p build/tests
	$(CC) $(STRICT) $(COMPILED) $(INCLUDE) $(NOTE) $< build/mpm.o -o $@ $(LDFLAGS) -lm

keys: ## docs/keys.md: what the files of the programs hold, with units
	@mkdir -p build
	$(CC) $(STRICT) $(INCLUDE) docs/keys.c -o build/keys $(LDFLAGS) -lm
	build/keys >docs/keys.md.part && mv docs/keys.md.part docs/keys.md

footprint: ## what each header costs - code, stack, memory, compile time: its table in docs/performance.md (5 minutes)
	sh bench/footprint.sh "$(CC)"

# What a package manager takes: the headers, mpm.c for whoever compiles once, the licence, a pkg-config file.
# The library has no code of its own to install, so all but the headers goes under share/. DESTDIR goes in front.
INCLUDE_TO = $(DESTDIR)$(PREFIX)/include
SHARE_TO   = $(DESTDIR)$(PREFIX)/share
install: ## headers, mpm.c and mpm.pc under PREFIX=/usr/local; packagers: DESTDIR=
	mkdir -p $(INCLUDE_TO) $(SHARE_TO)/mpm $(SHARE_TO)/pkgconfig
	install -m 644 $(HEADERS) $(INCLUDE_TO)
	install -m 644 mpm.c LICENSE $(SHARE_TO)/mpm
	sed 's,@PREFIX@,$(abspath $(PREFIX)),; s,@VERSION@,$(VERSION),' packaging/mpm.pc.in >$(SHARE_TO)/pkgconfig/mpm.pc
	chmod 644 $(SHARE_TO)/pkgconfig/mpm.pc

uninstall: ## removes what install wrote, with the same PREFIX and DESTDIR
	rm -f $(addprefix $(INCLUDE_TO)/,$(HEADERS)) $(SHARE_TO)/pkgconfig/mpm.pc
	rm -f $(SHARE_TO)/mpm/mpm.c $(SHARE_TO)/mpm/LICENSE
	-rmdir $(SHARE_TO)/mpm

build/mpm_all.h: mpm.c $(HEADERS) LICENSE packaging/all.sh
	@mkdir -p build
	sh packaging/all.sh $(VERSION) >$@.part && mv $@.part $@

dist: build/mpm_all.h ## a release: build/mpm-VERSION.tar.gz, and build/mpm_all.h with all headers in one file
	sh packaging/dist.sh $(VERSION)

clean: ## removes build/
	rm -rf build

.PHONY: all help run web live-test predict test embedded fuzz hard coverage verify impacts reproduction spray-study bench bench-against footprint figures keys install uninstall dist clean
