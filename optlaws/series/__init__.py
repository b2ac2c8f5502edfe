"""The former room of `optlaws.numerics`: pickles made before name it."""
