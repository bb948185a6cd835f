"""The types of the summary say what a run writes."""

import types
from typing import Union, get_args, get_origin

import pytest
from typing_extensions import get_type_hints, is_typeddict

import carom
import restarting
from carom.io.summary_types import Summary


def check(value, kind, place="summary"):
    """Refuse a value that is not what its type says, and keys that are missing or too many."""
    if is_typeddict(kind):
        missing = kind.__required_keys__ - value.keys()
        unknown = value.keys() - get_type_hints(kind).keys()
        assert not missing | unknown, place
        for key, hint in get_type_hints(kind).items():
            if key in value:
                check(value[key], hint, f"{place}.{key}")
    elif get_origin(kind) in (Union, types.UnionType):
        some = [one for one in get_args(kind) if one is not type(None)]
        assert value is not None or len(some) < len(get_args(kind)), place
        if value is not None:
            check(value, some[0], place)
    elif get_origin(kind) is list:
        assert value, f"{place}: shows nothing of its members"
        for member in value:
            check(member, get_args(kind)[0], f"{place}[]")
    elif get_origin(kind) is dict:
        assert all(type(member) is get_args(kind)[1] for member in value.values()), place
    elif get_args(kind):  # literals
        assert value in get_args(kind), place
    else:
        assert type(value) is kind, place


def test_the_summary_has_the_keys_and_types_that_it_promises(tmp_path):
    scenario = restarting.scenario("contact.solver.cross_check=true", "materials.elastic.young=27")
    stop = carom.Observer(lambda state: stop_at(state.time))
    with pytest.warns(carom.CaromWarning, match="waves run at 6.32"):
        whole = carom.run(scenario, out=tmp_path)
        stopped = carom.run(scenario, out=tmp_path, observers=[stop], force=True)
    check(whole.summary, Summary)
    check(stopped.summary, Summary)


def stop_at(time):
    if time > 0.1:
        raise carom.Stop
