"""What compiled functions may do to floating-point arithmetic."""

FAST = {"reassoc", "contract", "nsz"}
