# Everything a fresh machine with Rust needs: `make run` for the main job, `make test` for all checks.

SCENE ?= dpd-fluid
OUT ?= runs/$(basename $(notdir $(SCENE)))
ARGUMENTS ?=

# Results of an earlier `make run` may go; those in a directory the user named may not.
FORCE := $(if $(filter file,$(origin OUT)),--force)

# Rust's installer puts cargo here, but not every shell has been started since.
export PATH := $(PATH):$(HOME)/.cargo/bin

# Mesa complains without a runtime directory.
ifndef XDG_RUNTIME_DIR
export XDG_RUNTIME_DIR := $(or $(TMPDIR),/tmp)/mesoscope-runtime-$(shell id -u)
$(shell mkdir -p -m 700 "$(XDG_RUNTIME_DIR)")
endif

.DEFAULT_GOAL := help
.PHONY: help run test test-python validate test-mpi bench gpu-report book adapter cargo

help: ## this list
	@echo 'make TARGET [SCENE=dpd-fluid] [OUT=directory] [ARGUMENTS="--set time.step=0.02"]'
	@sed -n 's/^\([a-z-]*\):.*## /  \1\t/p' $(firstword $(MAKEFILE_LIST)) | expand -t 14

run: cargo adapter ## simulate SCENE into OUT, on the best adapter there is
	cargo run --release --locked -- run $(SCENE) --out $(OUT) $(FORCE) $(ARGUMENTS)

# Short tests of the device, to be run a second time with the plans that every GPU gets; those of determinism compare both plans anyway.
ON_GPU_PLANS := single_steps:: smoothing:: harmonic_chain::

# Features that the tests are built with; lints and documentation are of the default ones.
FEATURES :=
WITH_FEATURES := $(FEATURES:%=--features mesoscope/%)

test: cargo adapter ## formatting, lints, all tests, documentation, and the book where mdbook is installed
	@sh .ci/spirv.sh
	cargo fmt --all --check
	cargo clippy --locked --workspace --all-targets -- -D warnings
	cargo test --locked --workspace --no-fail-fast $(WITH_FEATURES)
	MESOSCOPE_PLAN=gpu cargo test --locked --workspace $(WITH_FEATURES) --test library -- $(ON_GPU_PLANS)
	# With examples, of which there are none, dependencies have the features that they have for tests: nothing is checked again.
	RUSTDOCFLAGS='-D warnings' cargo doc --locked --workspace --no-deps --lib --examples
	@if command -v mdbook >/dev/null; then sh .ci/book.sh; fi
	@sh .ci/python.sh dev

test-python: cargo adapter ## the Python package, installed into a virtual environment in target/python
	@sh .ci/python.sh dev

validate: cargo adapter ## the long tests, and all tests on other drivers
	@sh .ci/spirv.sh
	cargo check --locked --package mesoscope --lib --no-default-features
	cargo package --workspace --exclude mesoscope-python --locked --allow-dirty
	NODE_PATH=$$(sh .ci/tint.sh) cargo test --release --locked -- --ignored --show-output
	bash .ci/drivers.sh
	@sh .ci/python.sh release

# `make test-mpi MPI_TESTS=` leaves out the tests that take minutes.
MPI_TESTS := --include-ignored

test-mpi: cargo adapter ## the tests of ranks that are processes, with an MPI library
	@sh .ci/mpi.sh
	cargo clippy --locked --workspace --features mesoscope/mpi --bins --test mpi -- -D warnings
	cargo test --locked --workspace --features mesoscope/mpi --test mpi -- $(MPI_TESTS)

bench: cargo adapter ## cost per particle-step and per stage
	cargo bench --locked

gpu-report: cargo ## a report on this machine's graphics card in gpu-report.md, to paste; some twenty minutes
	cargo bench --locked --bench gpu_report -- --out $(CURDIR)/gpu-report.md $(ARGUMENTS)

book: ## the documentation as a book in target/book, with mdBook
	sh .ci/book.sh

adapter: ## a software Vulkan driver, where there is no Vulkan adapter
	@sh .ci/adapter.sh

cargo:
	@command -v cargo >/dev/null || { \
		echo 'error: cargo was not found. Install Rust from https://rustup.rs, then open a new shell.' >&2; exit 1; }
