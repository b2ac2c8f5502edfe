"""The job about whole cycles in machine units: entries, tables, pictures."""
