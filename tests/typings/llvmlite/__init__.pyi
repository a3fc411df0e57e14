"""The part of llvmlite that OnPath uses, typed; it has no stubs of its own."""
