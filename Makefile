# Protis: build, demo, tests, benchmarks. "make help" lists the targets.
BUILD ?= release
V     ?= 0
JOBS  ?= $(shell nproc 2>/dev/null || echo 2)
CC    ?= gcc

# Objects of clang and gcc stand apart.
out   := build/$(BUILD)$(if $(findstring clang,$(CC)),-clang)
comma := ,
Q     := $(if $(filter 1,$(V)),,@)

packages := gcc make pkg-config libsuitesparse-dev libopenblas-dev \
            liblapacke-dev libhdf5-dev libgmsh-dev check gnuplot-nox \
            libsundials-dev python3
pc       := hdf5-serial check
# Of tools/plot and tools/report; of the test of pages in a browser.
drawing  := python3-matplotlib python3-h5py
browser  := $(drawing) chromium chromium-driver python3-selenium

# Packages first: the variables below ask pkg-config.
dpkg     := $(shell command -v dpkg-query 2>/dev/null)
absent    = $(if $(dpkg),$(filter-out $(shell dpkg-query -W \
              -f='$${Package}=$${Status}\n' $(1) 2>/dev/null | \
              sed -n 's/=.* ok installed//p'),$(1)))
missing  := $(call absent,$(packages))
# Where there is no dpkg: what the compiler must find.
headers  := cholmod.h umfpack.h lapacke.h cblas.h hdf5.h gmshc.h check.h

march    := $(if $(filter x86_64-%,$(shell $(CC) -dumpmachine 2>/dev/null)),\
              -march=x86-64-v2)
warnings := -Wall -Wextra -Wno-unused-parameter -Wpedantic -Wshadow -Wconversion \
            -Wno-sign-conversion -Werror
optimise_release := -O3 $(march) -g1 -fno-math-errno
optimise_debug   := -O0 -g3
# Where tests look for faults, locals that are read before they are set are no
# plausible numbers.
spoilt           := -ftrivial-auto-var-init=pattern
optimise_asan    := -O1 -g2 -fsanitize=address,undefined $(spoilt) \
                    -fno-sanitize-recover=all -fno-omit-frame-pointer
optimise_cover   := -O0 -g1 --coverage $(spoilt)
optimise := $(optimise_$(BUILD))
$(if $(optimise),,$(error BUILD=$(BUILD): release, debug, asan or cover))

CPPFLAGS += -Isrc -Ibuild -D_POSIX_C_SOURCE=200809L -D_DEFAULT_SOURCE \
            $(shell pkg-config --cflags hdf5-serial 2>/dev/null) \
            -I/usr/include/suitesparse
CPPFLAGS += $(DEFINES)
CFLAGS   += -std=c11 $(warnings) $(optimise)
LDFLAGS  += $(filter -fsanitize% --coverage,$(optimise))
# Of builds that count branches: what _exit would lose.
leave_cover := $(out)/tests/preload/leave.o
leave    := $(leave_$(BUILD))
LDFLAGS  += $(if $(leave),-Wl$(comma)--wrap=_exit)
# Debian's HDF5 is linked with libraries of the net, whose loading would be half
# of the start of a process: its archive is taken, which needs none of them.
hdf5     := $(shell pkg-config --libs hdf5-serial 2>/dev/null)
archive  := $(if $(dpkg),$(wildcard $(patsubst -L%,%/libhdf5.a,$(filter -L%,$(hdf5)))))
LDLIBS   += -lumfpack -lcholmod -lcamd -lsuitesparseconfig -llapacke -lopenblas \
            $(if $(archive),$(archive) -lsz -lz,$(hdf5)) -ldl -lm
# The program itself starts in a third of the time where the dynamic loader has
# little to do: it takes archives, or the above where one of them is missing.
# Of the library of Fortran they need one call, which base/text.c has. At a fixed
# address there is nothing to relocate.
static   := -no-pie -Wl$(comma)--start-group \
            $(patsubst %,-l:lib%.a,umfpack cholmod amd camd colamd ccolamd \
              suitesparseconfig lapacke openblas sz aec z) $(archive) \
            -Wl$(comma)--end-group -l:libmetis.so.5 -lgomp -ldl -lm
checklib := $(shell pkg-config --libs check 2>/dev/null)

sources  := $(filter-out src/main.c,$(wildcard src/*/*.c src/*/*/*.c))
embedded := $(sort $(wildcard src/manual/*.md src/manual/*.inp \
              src/manual/*.txt input/*/*.inp input/*/*.geo))
objects  := $(sources:%.c=$(out)/%.o) $(out)/embedded.o
library  := $(out)/libprotis.a
program  := $(out)/protis

unit_c   := $(wildcard tests/unit/*.c)
unit     := $(unit_c:%.c=$(out)/%)
regr_c   := $(wildcard tests/regression/*.c)
regr     := $(regr_c:%.c=$(out)/%)
stab_c   := $(wildcard tests/stability/*.c)
stab     := $(stab_c:%.c=$(out)/%)
bench_c  := $(wildcard tests/bench/*.c)
bench    := $(bench_c:%.c=$(out)/%)
peers_c  := $(wildcard tests/peers/*.c)
peers    := $(peers_c:%.c=$(out)/%)
verify_c := $(wildcard tests/verify/*.c)
verify   := $(verify_c:%.c=$(out)/%)
tort_c   := $(wildcard tests/torture/*.c)
tort     := $(tort_c:%.c=$(out)/%)
mesher   := $(out)/tests/preload/mesher
preload  := $(out)/tests/preload/refuse.so $(mesher) $(out)/tests/preload/mesh.so
# The sanitiser of addresses wants to be loaded first.
kept     := $(if $(filter asan,$(BUILD)),,$(lastword $(preload)))
support  := $(patsubst %.c,$(out)/%.o,$(wildcard tests/support/*.c \
              tests/scenes/*.c tests/decks/*.c))

.PHONY: all help deps demo test check unit regression stability layers style \
        format bench bench-big bench-solvers bench-auto bench-fclib clean
.DEFAULT_GOAL := all
.SECONDARY:

# These start make once more: with other goals one after the other, or both
# would make the same files.
again    := all demo test bench bench-peers gallery browser-test
ifneq ($(and $(filter $(again),$(MAKECMDGOALS)),$(word 2,$(MAKECMDGOALS))),)
.NOTPARALLEL:
endif

all: deps
	$(Q)$(MAKE) --no-print-directory -j$(JOBS) $(program)

help:
	@echo "make              build $(program) (BUILD=release|debug|asan|cover)"
	@echo "make demo         install what is missing, build, run the examples"
	@echo "make test         install what is missing, build, run every test"
	@echo "make unit         unit tests alone;   make regression: decks alone"
	@echo "make stability    hard cases and 10000 random problems: minutes"
	@echo "make scenes       the matrix of hard scenes and methods alone"
	@echo "make torture      memory, files, kills, random input: a table, an hour"
	@echo "make mutants      which test sees each of a list of single wrong lines"
	@echo "make coverage     lines and branches of src the tests run; needs gcovr"
	@echo "make verify       orders of convergence, observed and expected"
	@echo "make effects-cost instructions of builds without an effect; needs valgrind"
	@echo "make gallery      pictures of all examples for the manual"
	@echo "make browser-test pages of tools/report in a headless browser"
	@echo "make sums-update  plans and sums of all examples, where they were meant to change"
	@echo "make reference    every example against its input/*/reference (-update)"
	@echo "make viewers      JOB.xdmf read by VTK, pyvista, meshio from PyPI"
	@echo "make study        error against CPU seconds: pictures"
	@echo "make bench        benchmarks against the limits of the machine"
	@echo "make fuzz         hostile input, FUZZ_SECONDS each; needs clang-14"
	@echo "make bench-big    large contacts, minutes and gigabytes; ROW=N one of them"
	@echo "make bench-solvers  what each digit costs, for every solver"
	@echo "make bench-auto   METHOD=AUTO against the best of the others"
	@echo "make bench-fclib  the same on problems from files, DIR=FOLDER"
	@echo "make bench-peers  AUTO against the kernels of Siconos, if installed"
	@echo "make manual       the manual as pages of HTML and man; needs pandoc"
	@echo "make install      below PREFIX=/usr/local; DESTDIR=; make uninstall, deb"
	@echo "make format       clang-format on all sources"
	@echo "make clean        remove build/"

define install
	@[ -z "$(1)" ] || { echo "installing: $(strip $(1))"; \
	  if [ "$$(id -u)" = 0 ]; then s=; else s=sudo; fi; \
	  $$s apt-get update -qq && DEBIAN_FRONTEND=noninteractive \
	  $$s apt-get install -y -qq --no-install-recommends $(1) \
	  > /dev/null || { echo "cannot install: $(strip $(1))" >&2; exit 1; }; }
endef

.PHONY: deps-drawing deps-browser
deps-drawing: deps
	$(call install,$(call absent,$(drawing)))

deps-browser: deps
	$(call install,$(call absent,$(browser)))

deps:
	$(call install,$(missing))
ifeq ($(dpkg),)
	@none=; pkg-config --version > /dev/null 2>&1 || none=' pkg-config'; \
	for h in $(headers); do \
	  echo "#include <$$h>" | $(CC) $(CPPFLAGS) -E - \
	    > /dev/null 2>&1 || none="$$none $$h"; done; \
	[ -z "$$none" ] || { echo "missing:$$none; install the libraries they" \
	  "belong to (Debian: $(packages))" >&2; exit 1; }
endif

# The numbers, titles and remedies of the messages, as the manual has them.
messages := build/base/messages.h
$(messages): src/manual/messages.md tools/list_messages
	@mkdir -p $(@D)
	$(Q)tools/list_messages $< > $@.new && mv $@.new $@

$(out)/%.o: %.c Makefile | $(messages)
	@mkdir -p $(@D)
	@echo "  CC   $<"
	$(Q)$(CC) $(CPPFLAGS) $(CFLAGS) -MMD -MP -c $< -o $@

# Chapters of the manual and examples: the program carries them.
$(out)/embedded.c: tools/embed $(embedded)
	@mkdir -p $(@D)
	$(Q)tools/embed $(embedded) > $@.new && mv $@.new $@

$(out)/embedded.o: $(out)/embedded.c
	@echo "  CC   $<"
	$(Q)$(CC) $(CPPFLAGS) $(CFLAGS) -c $< -o $@

# The commit that --version tells; main.o follows it.
commit   := $(shell git describe --always --dirty --abbrev=10 \
              --exclude '*' 2>/dev/null || echo unknown)
$(out)/commit: FORCE
	@mkdir -p $(@D)
	@echo '$(commit)' | cmp -s - $@ || echo '$(commit)' > $@
.PHONY: FORCE
$(out)/src/main.o: $(out)/commit
$(out)/src/main.o: CPPFLAGS += -DPROTIS_COMMIT='"$(commit)"'

$(library): $(objects)
	@echo "  AR   $@"
	$(Q)rm -f $@ && ar rcs $@ $^

$(program): $(out)/src/main.o $(leave) $(library)
	@echo "  LD   $@"
	$(Q)$(CC) $(LDFLAGS) $^ $(static) -o $@ 2> /dev/null || \
	  $(CC) $(LDFLAGS) $^ $(LDLIBS) -o $@

# See tests/support/marks.h.
marks := -Wl$(comma)--wrap=_mark_point
$(out)/tests/%: $(out)/tests/%.o $(support) $(leave) $(library)
	@echo "  LD   $@"
	$(Q)$(CC) $(LDFLAGS) $(marks) $^ $(checklib) $(LDLIBS) -o $@

$(out)/tests/%.o: CPPFLAGS += -Itests

# Floating-point traps for whole runs of the program.
$(out)/tests/preload/traps.so: tests/preload/traps.c Makefile
	@mkdir -p $(@D)
	@echo "  LD   $@"
	$(Q)$(CC) -std=c11 $(warnings) -shared -fPIC $< -o $@ -lm -lpthread

$(out)/tests/regression/examples: | $(out)/tests/preload/traps.so
$(out)/tests/regression/interrupt: | $(out)/tests/preload/nolocks.so

# Calls that fail: listed in a header, put in the place of the real ones.
failing  := $(out)/tests/preload/failing.o $(out)/tests/preload/main.o
wrapped  := child_run \
            $(shell sed -n '/^  X./{s/^  X.//;s/[^A-Za-z0-9_].*//p}' \
              tests/preload/failing.h)
$(out)/tests/torture/calls: $(failing)
$(out)/tests/torture/calls: LDFLAGS += $(wrapped:%=-Wl$(comma)--wrap=%)
$(out)/tests/torture/calls: LDLIBS := $(library) \
              $(if $(archive),$(patsubst $(archive),$(hdf5),$(LDLIBS)),$(LDLIBS))
$(out)/tests/preload/main.o: $(out)/src/main.o
	@mkdir -p $(@D)
	$(Q)objcopy --redefine-sym main=protis_main $< $@

# An independent integrator, of one test alone.
$(out)/tests/unit/sundials: LDLIBS += -lsundials_cvode -lsundials_nvecserial \
              -lsundials_sunlinsoldense -lsundials_sunmatrixdense

# Stands between a program under test and the C library.
$(out)/tests/preload/mesh.so: src/mesh/raw.h tests/preload/guard.c
$(out)/tests/preload/%.so: tests/preload/%.c Makefile | $(messages)
	@mkdir -p $(@D)
	@echo "  LD   $@"
	$(Q)$(CC) -std=gnu11 -Isrc -Ibuild -O3 -Wall -Wextra -shared -fPIC $(filter %.c,$^) -o $@ -ldl

# A fresh machine has no pkg-config when make starts: install, then start anew.
demo test: deps-drawing
demo test bench: deps
	$(Q)$(MAKE) --no-print-directory -j$(JOBS) $@-run

.PHONY: demo-run test-run bench-run
demo-run: $(program)
	$(Q)tools/demo $(program) build/demo

test-run: check

check: layers style tests-run

tools_py := $(patsubst %.py,$(out)/%,$(wildcard tests/tools/*.py))
pages    := $(out)/tests/tools/browser
tool     := $(filter-out $(pages),$(tools_py))
suite    := JOBS=$(JOBS) PROTIS=$(abspath $(program)) \
            PROTIS_REFUSE=$(abspath $(firstword $(preload))) \
            PROTIS_MESH=$(abspath $(kept))

# Those of the tools are in Python; torture: a slice of make torture.
.PHONY: tests-run tool-tests torture-slice
tests-run:     $(tort) $(tool) $(regr) $(unit)
unit:          $(unit)
regression:    $(regr)
tool-tests:    $(tool)
torture-slice: $(tort)
tests-run unit regression tool-tests torture-slice: $(program) $(preload)
	$(Q)$(suite) tools/run_tests $(filter-out $(program) $(preload),$^)

# tests/regression/plans and sums again, where examples were meant to change.
.PHONY: sums-update
sums-update: $(program) $(mesher) $(kept) $(out)/tests/regression/examples
	$(Q)PROTIS=$(abspath $(program)) PROTIS_MESH=$(abspath $(kept)) \
	  PROTIS_SUMS=update $(out)/tests/regression/examples

# In a browser: what tools/report writes.
.PHONY: browser-test browser-run gallery gallery-run
$(out)/tests/tools/%: tests/tools/%.py
	$(Q)install -D $< $@

gallery: deps-drawing
browser-test: deps-browser
gallery browser-test:
	$(Q)$(MAKE) --no-print-directory -j$(JOBS) $(@:-test=)-run

browser-run: $(program) $(pages)
	$(Q)PROTIS=$(abspath $(program)) tools/run_tests $(pages)

# The pictures of src/manual/gallery.md, the same bytes each time; pages of the
# examples in build/gallery.
gallery-run: $(program)
	$(Q)tools/plot example all -o build/gallery --pictures src/manual/pictures \
	  --program $(program) 2> build/gallery.log || { cat build/gallery.log; exit 1; }
	$(Q)for f in build/gallery/*.json; do tools/report $$f || exit 1; done

# Memory refused, files that fail, kills, of which the tests have a slice, with
# random problems and decks in one table; POINTS: of each kind, by and large.
POINTS  ?= 20000
.PHONY: torture
torture: $(program) $(preload) $(tort) $(out)/tests/unit/conformance \
         $(out)/tests/unit/deck_hostile $(out)/tests/unit/hdf5 \
         $(out)/tests/stability/lcp $(out)/tests/regression/mutants
	$(Q)$(suite) PROTIS_POINTS=$(POINTS) tools/torture \
	  $(filter-out $(program) $(preload),$^)

# Which test sees each single wrong line of tests/mutants/list, built in a copy
# of the sources below build/mutants. FULL=1: all tests for what those named
# there do not see; SLICE=1/4: the first of four parts; MUTANT=: by name.
SLICE   ?= 1/1
.PHONY: mutants
mutants: deps
	$(Q)tests/mutants/run --jobs $(JOBS) --slice $(SLICE) $(if $(FULL),--full) \
	  $(MUTANT)

# What the tests run of src; needs gcovr, no part of the tests.
.PHONY: coverage
coverage:
	$(Q)find build/cover -name '*.gcda' -delete 2>/dev/null || true
	$(Q)PROTIS_CALLS=all $(MAKE) --no-print-directory BUILD=cover -k unit \
	  regression torture-slice; tools/coverage build/cover

# Hard cases: the matrix of scenes (SCENE=name: those alone), every other
# program of tests/stability, and the long run of the conformance test.
PROBLEMS ?= 10000
SEED     ?= 0
scenes   := $(out)/tests/stability/scenes
.PHONY: scenes
scenes: $(program) $(scenes)
	$(Q)JOBS=$(JOBS) PROTIS=$(abspath $(program)) $(scenes)

# Programs of make test that run all their cases here (unit_whole).
whole    := $(addprefix $(out)/tests/unit/,average conformance fixed_point \
              fracture history mesh_reader methods nonlocal records \
              solver_block sundials work) \
            $(addprefix $(out)/tests/regression/,goal_targets partial_slip)
stability: $(program) $(stab) $(whole) scenes reference
	$(Q)JOBS=$(JOBS) PROTIS=$(abspath $(program)) PROTIS_PROBLEMS=$(PROBLEMS) \
	  PROTIS_SEED=$(SEED) tools/run_tests $(filter-out $(program) $(scenes) scenes reference,$^)

layers: $(objects)
	$(Q)tools/check_layers src $(objects)

style:
	$(Q)CC="$(CC)" tools/test_checks build/test_checks
	$(Q)tools/check_style src tests
	$(Q)tests/mutants/run --check

bench-run: $(program) $(bench)
	$(Q)for b in $(filter-out %/auto %/fclib,$(bench)); do $$b || exit 1; done

# Programs of tests/verify print tables: found and expected.
.PHONY: verify
verify: $(program) $(verify)
	$(Q)for v in $(verify); do PROTIS=$(abspath $(program)) CK_TIMEOUT_MULTIPLIER=10 \
	  $$v || exit 1; done

# What is off costs nothing: instructions counted by valgrind.
.PHONY: effects-cost
effects-cost: $(program)
	$(Q)tools/effects_cost

# Every example against the part of its tables that is kept beside it; -update:
# what is kept becomes that of this program.
.PHONY: reference reference-update
reference reference-update: $(program)
	$(Q)PROTIS=$(abspath $(program)) tools/reference $(if $(filter %-update,$@),--update) -j $(JOBS) \
	  -o build/reference input/*/*.inp

# JOB.xdmf in the readers of VTK, pyvista and meshio, the package of
# tools/python installed by pip; both from PyPI, no part of the tests.
.PHONY: viewers
viewers: $(program)
	$(Q)python3 -m venv build/viewers
	$(Q)cp -r tools/python build/viewers
	$(Q)build/viewers/bin/pip -q install vtk pyvista meshio build/viewers/python
	$(Q)for d in greco/greco block_shear_3d/block_shear_3d \
	    hertz_sphere/hertz_sphere relaxing_seal/relaxing_seal; do \
	  $(program) input/$$d.inp -o build/viewers/out --quiet || exit 1; done
	$(Q)build/viewers/bin/python tools/check_xdmf \
	  $$(ls build/viewers/out/*.xdmf | grep -v "\.[a-z]*\.xdmf")

# Error against CPU seconds: solvers, meshes, integrators, nonlocal radii.
STUDY := PROTIS=$(abspath $(program)) tools/study -j $(JOBS)
comma := ,
sp    := $(subst ,, )
EXACT := PEAK=2710.98998,WIDE=0.235260953,SIDE=-0.00123809517
GOALS := input/hertz_line/hertz_goals.inp --error GOALS --reference $(EXACT)
.PHONY: study
study: $(program)
	$(Q)$(STUDY) input/greco/greco.inp -o build/study/solvers \
	  --vary TOL=1e-1,1e-2,1e-3,1e-4,1e-6,1e-8,1e-12 \
	  --vary METHOD=AITKEN,SOR,NEWTON --vary N=128 --floor 1e-10 \
	  --cost "contact solver" \
	  --title "block, 128 segments: what a digit costs with three solvers"
	$(Q)$(STUDY) input/hertz_line/hertz_exact.inp -o build/study/meshes \
	  --vary N=2,4,8,16,32 \
	  --title "Hertz against its closed form, N segments per half-width"
	$(Q)$(STUDY) input/creep_block/held_block.inp -o build/study/integrators \
	  --vary DT=1,0.5,0.25,0.125,0.0625,0.03125,0.015625 \
	  --vary INTEGRATOR=EULER,BACKWARD,HEUN,MIDPOINT,RK4,EXPONENTIAL \
	  --error TOTALS.force_y --reference 225.374497087 --floor 1e-8 \
	  --title "relaxing block: six integrators, increments DT"
	$(Q)$(STUDY) input/nonlocal_slider/nonlocal_hertz.inp \
	  -o build/study/radii --vary NC=8,16,32,64,128 \
	  --vary RHO=0.02,0.05,0.1 --error CONTACT.traction_t --reference own \
	  --title "sliding cylinder, nonlocal friction of radius RHO"

	$(Q)$(STUDY) $(GOALS) -o build/study/goals/uniform --vary N=4,8,16,32,64
	$(Q)$(STUDY) $(GOALS) -o build/study/goals/energy \
	  --vary TARGET=6,4,2.5,1.5,1,0.6 --vary N=4
	$(Q)$(STUDY) $(GOALS) -o build/study/goals/goal --vary N=4 --vary \
	  GOAL_TARGET=$(subst $(sp),$(comma),$(strip $(foreach g,PEAK WIDE SIDE,\
	  $(foreach t,1% 0.3% 0.1% 0.03% 0.01%,$g:$t))))
	$(Q)tools/plot goals build/study/goals build/study/goals.png \
	  $(subst $(comma), ,$(EXACT))

bench-big: $(program) $(out)/tests/bench/size $(out)/tests/bench/condense
	$(Q)BIG=1 PROTIS=$(abspath $(program)) $(out)/tests/bench/size
	$(if $(ROW),,$(Q)$(out)/tests/bench/condense threads)
bench-solvers: $(out)/tests/bench/solvers
	$(Q)$<

bench-auto: $(out)/tests/bench/auto
	$(Q)$<

# Problems from files, of a folder: DIR=; next to another library where that is
# installed.
bench-fclib: $(out)/tests/bench/fclib
	@test -n "$(DIR)" || { echo "bench-fclib: DIR= a folder of FCLIB files" \
	  >&2; exit 1; }
	$(Q)$< $(sort $(wildcard $(DIR)/*.hdf5 $(DIR)/*.h5))
	$(Q)! test -d $(SICONOS)/numerics || { \
	  $(MAKE) --no-print-directory $(out)/tests/peers/files && \
	  $(out)/tests/peers/files $(sort $(wildcard $(DIR)/*.hdf5 $(DIR)/*.h5)); }

# Against another library, which nothing else needs.
SICONOS ?= /usr/include/siconos
.PHONY: bench-peers
$(out)/tests/peers/%.o: CPPFLAGS += -isystem $(SICONOS) \
                                    -isystem $(SICONOS)/numerics
$(peers): LDLIBS += -lsiconos_numerics
bench-peers:
	@test -d $(SICONOS)/numerics || { echo "bench-peers: no folder" \
	  "$(SICONOS)/numerics: install libsiconos-numerics-dev" >&2; exit 1; }
	$(Q)$(MAKE) --no-print-directory $(out)/tests/peers/peers
	$(Q)$(out)/tests/peers/peers

format:
	$(Q)clang-format-14 --style=file:tools/clang-format -i $(wildcard src/*.[ch] src/*/*.[ch] \
	  src/*/*/*.[ch] tests/*/*.[ch])

# Hostile input for every reader; needs clang-14 and libclang-rt-14-dev, no part
# of the tests. Seeds stand in tests/fuzz/seeds, those of the deck are the
# examples too; what is found on the way is kept in build/fuzz. FUZZ=: some.
FUZZ_SECONDS ?= 60
FUZZ       ?= $(patsubst tests/fuzz/%.c,%,$(wildcard tests/fuzz/*.c))
fuzzers    := $(FUZZ:%=build/fuzz/%)
fuzz_lib   := build/fuzz/libprotis.a
fuzz_c     := $(CPPFLAGS) -Itests -std=c11 -g -O2 -fno-sanitize-recover=all
fuzz_run   := -max_total_time=$(FUZZ_SECONDS) -timeout=10 -rss_limit_mb=1000 \
              -entropic=0 -print_final_stats=1

.PHONY: fuzz
fuzz: $(fuzzers)
	$(Q)for f in $(fuzzers); do mkdir -p $$f.corpus; length=4096; \
	  case $$f in \
	    *number) length=64;; *expression) length=96;; \
	    *deck) cp input/*/*.inp $$f.corpus;; esac; \
	  $$f $(fuzz_run) -max_len=$$length $$f.corpus \
	    tests/fuzz/seeds/$${f##*/} > $$f.log 2>&1 || \
	    { tail -n 40 $$f.log; exit 1; }; \
	  echo "$$f: $$(grep number_of_executed_units $$f.log)"; \
	done

build/fuzz/%.o: %.c | $(messages)
	@mkdir -p $(@D)
	@echo "  CC   $<"
	$(Q)clang-14 $(fuzz_c) -MMD -MP \
	  -fsanitize=fuzzer-no-link,address,undefined -c $< -o $@

# Counters of code that a fuzzer cannot reach would be looked at each time.
$(fuzz_lib): $(sources:%.c=build/fuzz/%.o) build/fuzz/tests/support/fuzz_file.o
	@echo "  AR   $@"
	$(Q)rm -f $@ && ar rcs $@ $^

build/fuzz/%: tests/fuzz/%.c $(fuzz_lib)
	@echo "  FUZZ $<"
	$(Q)clang-14 $(fuzz_c) -fsanitize=fuzzer,address,undefined $^ $(LDLIBS) \
	  -o $@

# Chapters as pages; those that tables complete are printed by the program.
pages_dir := build/manual
chapters   = $(shell $(program) --manual | sed -n 's/^  \([a-z]*\) .*/\1/p')
.PHONY: manual manual-run
manual: deps
	$(call install,$(call absent,pandoc))
	$(Q)$(MAKE) --no-print-directory -j$(JOBS) manual-run

manual-run: $(program)
	$(Q)rm -rf $(pages_dir) && mkdir -p $(pages_dir)
	$(Q)cp -R src/manual/pictures src/manual/manual.css $(pages_dir)
	$(Q)tools/shell_pages man $(abspath $(program)) > $(pages_dir)/protis.1
	$(Q)sed 's|(src/manual/|(|g' README.md > $(pages_dir)/index.md
	$(Q)for c in $(chapters); do \
	  $(program) --manual $$c > $(pages_dir)/$$c.md || exit 1; done
	$(Q)for c in index $(chapters); do \
	  { echo '[all chapters](index.html)'; echo; cat $(pages_dir)/$$c.md; } | \
	  sed 's/\(([a-z]*\)\.md)/\1.html)/g' | \
	  pandoc -f gfm -t html5 -s --toc --css manual.css --metadata title= \
	    --metadata pagetitle="Protis: $$c" -o $(pages_dir)/$$c.html && \
	  rm $(pages_dir)/$$c.md || exit 1; done
	@echo "open $(pages_dir)/index.html"

# The program with its manual page, the words that bash completes, examples and
# tools. The manual itself is within the program, which must be built.
PREFIX ?= /usr/local
share  := $(DESTDIR)$(PREFIX)/share
bash   := $(share)/bash-completion/completions
shown  := abaqus_mesh batch compare deck_tools.py effects pictures plot \
          plot_contact python reference report study
.PHONY: install install-files uninstall deb
install: all
	$(Q)$(MAKE) --no-print-directory install-files

install-files:
	$(Q)install -D -m 755 $(program) $(DESTDIR)$(PREFIX)/bin/protis
	$(Q)mkdir -p $(share)/man/man1 $(bash) $(share)/protis/tools
	$(Q)tools/shell_pages man $(abspath $(program)) > $(share)/man/man1/protis.1
	$(Q)tools/shell_pages completion $(abspath $(program)) > $(bash)/protis
	$(Q)for f in input/*/*.inp input/*/*.geo; do \
	  install -D -m 644 $$f $(share)/protis/examples/$${f#input/} || exit 1; done
	$(Q)cd tools && cp -R $(shown) $(share)/protis/tools
	$(Q)find $(share)/protis/tools -name __pycache__ -prune -exec rm -rf {} +
	@echo "installed below $(DESTDIR)$(PREFIX)"

uninstall:
	$(Q)rm -rf $(DESTDIR)$(PREFIX)/bin/protis $(share)/man/man1/protis.1 \
	  $(bash)/protis $(share)/protis
	$(Q)cd $(DESTDIR)$(PREFIX) 2> /dev/null || exit 0; for d in share/man/man1 \
	  $(patsubst $(DESTDIR)$(PREFIX)/%,%,$(bash)) bin; do \
	  [ ! -d $$d ] || rmdir -p --ignore-fail-on-non-empty $$d; done

# A package of Debian; what the program needs is asked of dpkg.
deb_is  := build/deb/protis
version  = $(shell $(program) --version | sed -n '1s/protis \([^ ]*\).*/\1/p')
deb: all
	$(Q)rm -rf $(deb_is) && mkdir -p $(deb_is)/DEBIAN
	$(Q)$(MAKE) --no-print-directory install PREFIX=/usr \
	  DESTDIR=$(abspath $(deb_is)) > /dev/null
	$(Q)need=$$({ ldd $(program) | sed -n 's|.*=> .*/\([^ ]*\).*|\1|p'; \
	  echo libgmsh.so.4.*; } | xargs -I '{}' \
	  dpkg-query -S '*/$(shell $(CC) -print-multiarch)/{}' | \
	  cut -d : -f 1 | sort -u | paste -s -d , -); \
	  printf '%s\n' 'Package: protis' 'Version: $(version)' \
	    "Architecture: $$(dpkg --print-architecture)" "Depends: $$need" \
	    'Recommends: gnuplot-nox, $(subst $() ,$(comma) ,$(strip $(drawing)))' \
	    'Maintainer: the authors of Protis <protis@localhost>' \
	    'Description: quasistatic frictional contact of elastic bodies' \
	    > $(deb_is)/DEBIAN/control
	$(Q)dpkg-deb --root-owner-group --build $(deb_is) build/deb > /dev/null
	@echo "built build/deb/protis_$(version)_$$(dpkg --print-architecture).deb"

clean:
	rm -rf build

-include $(shell find $(out) build/fuzz -name '*.d' 2>/dev/null)
