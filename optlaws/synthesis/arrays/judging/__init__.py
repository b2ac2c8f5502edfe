"""Whether many laws keep their rows everywhere, and what their multipliers prove."""
