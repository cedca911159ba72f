# mpm.h - the library is its headers; this builds the examples, the tests and the figures.
#   make            everything into build/
#   make run        the main job: an aluminium particle hits an aluminium plate at 810 m/s
#   make test       every test, double and float, and the compile tests
#   make bench      speed, as ratios measured in one run
#   make impacts    the impacts of docs/reproduction.md: bonded, unbonded, whole model, rim jet (6 minutes)
#   make spray-study source B's results again: a quarter of an hour, resumable; BUDGET=quick: less
#   make reproduction source A's results again: an hour; BUDGET=desk: nine hours; full: days; resumable
#   make verify     the verification ladder again: writes docs/verification.md; resumable, `make -j2 verify`
#   make clean

# Contraction off: the same source gives the same bits with and without fused multiply-add.
NATIVE := $(shell echo 'int x;' | $(CC) -march=native -xc -c -o /dev/null - 2>/dev/null && echo -march=native)
CFLAGS ?= -O3 $(NATIVE) -ffp-contract=off -fno-math-errno -fno-trapping-math
# Tests are compiled quickly; they hold at any level.
TESTFLAGS ?= -O2 -ffp-contract=off
STRICT  = -std=c99 -pedantic -Wall -Wextra -Wconversion -Wshadow
INCLUDE = -I. -Iexamples -Iexamples/studies -Itests
HEADERS = $(wildcard mpm*.h examples/*.h examples/studies/*.h tests/*.h tests/verify/*.h bench/*.h)

EXAMPLES = $(patsubst examples/%.c,build/%,$(wildcard examples/*.c)) $(patsubst examples/studies/%.c,build/%,$(wildcard examples/studies/*.c))
TESTS    = $(patsubst tests/%.c,build/tests/%,$(wildcard tests/[0-9]*.c))
FLOATS   = $(patsubst tests/%.c,build/tests/%_f32,$(wildcard tests/[0-9]*.c))
VERIFY   = $(patsubst tests/verify/%.c,build/verify/%.md,$(sort $(wildcard tests/verify/*.c)))
BENCH    = $(patsubst bench/%.c,build/bench/%,$(wildcard bench/*.c))

all: $(EXAMPLES) $(TESTS) $(FLOATS) $(BENCH)

run: build/impact
	build/impact --out build/impact-out

test: $(EXAMPLES) $(TESTS) $(FLOATS)
	@sh tests/run.sh $(TESTS) $(FLOATS) -- "$(CC)"

bench: $(BENCH)
	@for b in $(BENCH); do $$b || exit 1; done

build/%: examples/%.c $(HEADERS)
	@mkdir -p build
	$(CC) $(STRICT) $(CFLAGS) $(INCLUDE) $< -o $@ $(LDFLAGS) -lm

build/%: examples/studies/%.c $(HEADERS)
	@mkdir -p build
	$(CC) $(STRICT) $(CFLAGS) $(INCLUDE) $< -o $@ $(LDFLAGS) -lm

build/tests/%_f32: tests/%.c $(HEADERS)
	@mkdir -p build/tests
	$(CC) $(STRICT) $(TESTFLAGS) -DMPM_FLOAT $(INCLUDE) $< -o $@ $(LDFLAGS) -lm

build/tests/%: tests/%.c $(HEADERS)
	@mkdir -p build/tests
	$(CC) $(STRICT) $(TESTFLAGS) $(INCLUDE) $< -o $@ $(LDFLAGS) -lm

build/bench/%: bench/%.c $(HEADERS)
	@mkdir -p build/bench
	$(CC) $(STRICT) $(CFLAGS) $(INCLUDE) $< -o $@ $(LDFLAGS) -lm

build/verify/%: tests/verify/%.c $(HEADERS)
	@mkdir -p build/verify
	$(CC) $(STRICT) $(CFLAGS) $(INCLUDE) -Itests/verify $< -o $@ $(LDFLAGS) -lm

# One section of docs/verification.md; finished sections are kept.
build/verify/%.md: build/verify/%
	$< >$@.part && mv $@.part $@

verify: $(VERIFY)
	sh tests/verify/page.sh $(VERIFY) >docs/verification.md
	@grep -h '^[0-9]* rows' docs/verification.md

# The runs behind docs/reproduction.md and the README, and the numbers quoted there.
RIM = --geometry axisymmetric --cell 0.7 --spacing 0.175 --dt-factor 0.2 --frames 1 --quiet
impacts: build/impact
	build/impact --frames 0 --quiet --out build/bonded
	build/impact --frames 0 --quiet --out build/unbonded --bond none
	build/impact --frames 0 --quiet --out build/whole --symmetry full
	@grep -HE '"(pbcp_percent|v_rest_(mean|filtered)_m_s|eps_mean|temperature_max_K|energy_(error|unaccounted))"' \
		build/bonded/summary.json build/unbonded/summary.json build/whole/summary.json
	build/impact $(RIM) --diameter 38 --velocity 780 --substrate-diameter 63.3333 --substrate-height 12.6667 \
		--time 101.333 --out build/jet_38
	build/impact $(RIM) --diameter 45 --velocity 550 --substrate-diameter 75 --substrate-height 15 --time 120 \
		--out build/jet_45
	cp build/jet_38/impact.png docs/data/jet_38.png
	cp build/jet_45/impact.png docs/data/jet_45.png

# Writes its part of docs/reproduction.md, and docs/data; finished runs are kept in build/reproduction-out.
# The page in this repository is that of BUDGET=desk. DESK=crit,held runs these parts at the desk budget.
reproduction: BUDGET = quick
reproduction: build/reproduction
	build/reproduction --budget $(BUDGET) --desk "$(DESK)"

# Writes docs/spray.md and docs/data; finished runs are kept in build/spray_study.log.
BUDGET ?= full
spray-study: build/spray_study
	build/spray_study --budget $(BUDGET)

clean:
	rm -rf build

# sections are programs first: keep them
.PRECIOUS: build/verify/%

.PHONY: all run test verify bench impacts spray-study reproduction clean
