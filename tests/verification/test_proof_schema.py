"""The JSON Schema of certificates: every stored one obeys it, and what it refuses the library refuses too."""

import json
from functools import cache
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from optlaws import InputError, json_schema
from optlaws.verification import verify
from tests.check_proofs import RESULTS, certificates

SCHEMA = json_schema("certificate")


@cache
def validator() -> Draft202012Validator:
    Draft202012Validator.check_schema(SCHEMA)
    return Draft202012Validator(SCHEMA)


@cache
def stored(name: str) -> list[dict[str, Any]]:
    return [proof for _, proof in certificates(json.loads((RESULTS / name / "laws.json").read_text(encoding="utf8")))]


@pytest.mark.parametrize("name", ["optimal_table", "d_minimal", "mixed", "machine_sloshing"])
def test_stored_certificates_obey_it(name: str) -> None:
    assert stored(name)
    for certificate in stored(name):
        assert [error.message for error in validator().iter_errors(certificate)] == []


@pytest.mark.parametrize("kind", ["contacts", "steps"])
def test_what_it_refuses_is_refused(kind: str) -> None:
    whole = next(proof for proof in stored("d_minimal") if kind in proof)
    values: tuple[Any, ...] = ("text", {}, [None], 1e200)
    wrong = [
        *(whole | {key: value} for key in whole.keys() - {"problem", "about"} for value in values),
        *({key: value for key, value in whole.items() if key != missing} for missing in whole if missing != "bound"),
        whole | {"further": 1},
        *(whole | {"format": value} for value in (0, 2, 1.5, True, "1")),
    ]  # fmt: skip
    assert validator().is_valid(whole | {"format": 1})
    assert verify(whole | {"format": 1}) == verify(whole)
    for data in wrong:
        assert not validator().is_valid(data), data.keys()
        with pytest.raises(InputError):
            verify(data)
