"""What people see of long work and of values: bars, and small pages in notebooks."""
