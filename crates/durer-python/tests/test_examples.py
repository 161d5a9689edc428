"""Every example in a docstring runs."""

import doctest
import importlib
import pkgutil

import numpy as np
import pytest

import durer

MODULES = ["durer", *(f"durer.{m.name}" for m in pkgutil.iter_modules(durer.__path__) if m.name != "_native")]


@pytest.mark.parametrize("name", MODULES)
def test_examples_run(name, request):
    if name == "durer.trimesh":
        pytest.importorskip("trimesh")
    if name == "durer.distributed":
        pytest.importorskip("distributed")
    module = importlib.import_module(name)
    np.set_printoptions(legacy=False)
    results = doctest.testmod(module, extraglobs={"getfixture": request.getfixturevalue}, verbose=False)
    assert results.failed == 0


def test_public_names_have_docstrings_with_examples():
    for name in durer.__all__:
        thing = getattr(durer, name)
        assert ">>>" in (thing.__doc__ or ""), name
        if isinstance(thing, type):
            for attribute, value in vars(thing).items():
                if not attribute.startswith("_") and (callable(value) or isinstance(value, property)):
                    assert (value.__doc__ or "").strip(), f"{name}.{attribute}"
