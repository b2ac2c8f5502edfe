"""Internals of `optlaws.files` that tests look at by themselves."""

from optlaws.files import packaged, reading, tables, writing
from optlaws.files.tables import to_toml
from optlaws.files.writing import say_the_same
