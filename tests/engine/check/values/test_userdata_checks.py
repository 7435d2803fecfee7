"""Which userdata keys are defined where: along paths, through scopes, branches, rounds and trees."""

from __future__ import annotations

from pathlib import Path

from tests.engine.check.checking import code_paths, findings_in, findings_in_files, message_of

READ = "{state: store.ReadEntry, with: {kind: record, name: x}, out: {value: part}"
USE = '{state: flow.Log, with: {message: "${part.name}"}'


def test_a_key_that_one_outcome_leaves_unwritten_is_reported_with_the_way_there() -> None:
    """The way leads from the first node to the reader past everything that would write the key."""
    text = f"""
    root:
      machine:
        initial: read
        states:
          read: {READ}, transitions: {{found: use, missing: wait}}}}
          wait: {{state: flow.Wait, with: {{duration_s: 1}}, transitions: {{done: use}}}}
          use: {USE}, transitions: {{done: good}}}}
    """
    assert code_paths(text) == ["maybe-undefined-key root/use"]
    assert message_of(text).endswith("it is not defined on the path read → wait → use")


def test_the_way_goes_through_the_containers_around_the_reader() -> None:
    """Nodes of inner containers are named with their path."""
    text = f"""
    root:
      machine:
        initial: read
        states:
          read: {READ}, transitions: {{found: inner, missing: inner}}}}
          inner:
            machine:
              initial: wait
              states:
                wait: {{state: flow.Wait, with: {{duration_s: 1}}, transitions: {{done: use}}}}
                use: {USE}, transitions: {{done: ready}}}}
            transitions: {{ready: good}}
    """
    assert message_of(text).endswith("on the path read → inner/wait → inner/use")


def test_an_initial_value_defines_a_key_on_every_way() -> None:
    """With `userdata` at any container around, the same machine is in order."""
    text = f"""
    userdata: {{part: {{name: none}}}}
    root:
      machine:
        initial: read
        states:
          read: {READ}, transitions: {{found: use, missing: use}}}}
          use: {USE}, transitions: {{done: good}}}}
    """
    assert code_paths(text) == []


def test_a_loop_defines_what_is_written_in_its_first_round() -> None:
    """A reader that is reached only behind the writer is in order, however often."""
    text = f"""
    root:
      machine:
        initial: read
        states:
          read: {READ}, transitions: {{found: use, missing: bad}}}}
          use: {USE}, transitions: {{done: again}}}}
          again: {{state: gripper.CheckHeld, with: {{gripper: left}}, transitions: {{held: use, lost: read}}}}
    """
    assert code_paths(text) == []


def test_what_an_inner_container_writes_is_lost_at_its_end() -> None:
    """The reader behind it finds nothing; the hint names the writer."""
    text = f"""
    root:
      machine:
        initial: inner
        states:
          inner:
            machine:
              initial: read
              states: {{read: {READ}, transitions: {{found: ready, missing: lost}}}}}}
            transitions: {{ready: use, lost: bad}}
          use: {USE}, transitions: {{done: good}}}}
    """
    (finding,) = findings_in(text)
    assert (finding.code, finding.path) == ("undefined-key", "root/use")
    assert "`root/inner/read`" in finding.hint


def test_a_branch_keeps_what_its_machines_write_until_it_ends() -> None:
    """Inside a branch a key goes past the scope of an inner machine; behind the container it is gone."""
    text = f"""
    root:
      machine:
        initial: both
        states:
          both:
            concurrency:
              states:
                one:
                  machine:
                    initial: inner
                    states:
                      inner:
                        machine:
                          initial: read
                          states: {{read: {READ}, transitions: {{found: ready, missing: lost}}}}}}
                        transitions: {{ready: use, lost: lost}}
                      use: {USE}, transitions: {{done: done}}}}
              conditions: [{{ended: {{one: done}}}}, {{ended: {{one: lost}}}}]
            transitions: {{ended: late}}
          late: {USE}, transitions: {{done: good}}}}
    """
    assert code_paths(text) == ["undefined-key root/late"]


def test_a_condition_says_which_branches_have_certainly_written() -> None:
    """Behind the outcome for which the writer must have ended well, its key is defined."""
    text = f"""
    userdata: {{part: 1}}
    root:
      machine:
        initial: both
        states:
          both:
            concurrency:
              states:
                read: {READ}}}
                wait: {{state: flow.Wait, with: {{duration_s: 1}}}}
              conditions: [{{ready: {{read: found}}}}, {{lost: {{read: missing}}}}, {{late: {{wait: done}}}}]
            transitions: {{ready: use, lost: bad, late: bad}}
          use: {{state: store.WriteEntry, with: {{kind: record, name: x}}, in: {{value: part}}, transitions: {{written: good, conflict: bad}}}}
    """  # noqa: E501
    assert code_paths(text) == []
    assert code_paths(text.replace("lost: bad", "lost: use")) == ["maybe-type-mismatch root/use"]
    assert code_paths(text.replace("late: bad", "late: use")) == ["maybe-type-mismatch root/use"]


def test_branches_that_write_or_read_one_key_get_in_each_others_way() -> None:
    """Both are reported; keys that are not declared outside are each branch's own."""
    text = """
    userdata: {count: 0}
    root:
      concurrency:
        states:
          a: {state: flow.SetValue, with: {value: 1}, out: {value: count}}
          b: {state: flow.SetValue, with: {value: "${count + 1}"}, out: {value: count}}
        conditions: [{good: {a: done, b: done}}]
    """
    assert code_paths(text) == ["parallel-writers root/b", "sibling-read root/b"]
    own = """
    root:
      concurrency:
        states:
          a: {machine: {initial: set, states: {
            set: {state: flow.SetValue, with: {value: 1}, out: {value: count}, transitions: {done: use}},
            use: {state: flow.Log, with: {message: "${string(count)}"}, transitions: {done: done}}}}}
          b: {state: flow.SetValue, with: {value: 1}, out: {value: count}}
        conditions: [{good: {a: done, b: done}}]
    """
    assert code_paths(own) == []


SHARED = """
    userdata: {count: 0}
    root:
      concurrency:
        shared: [count]
        states:
          a: {state: flow.SetValue, with: {value: "${count + 1}"}, out: {value: count}}
          b: {state: flow.SetValue, with: {value: "${count + 1}"}, out: {value: count}}
        conditions: [{good: {a: done, b: done}}]
"""


def test_shared_keys_are_meant_to_be_written_by_branches_and_read_by_others() -> None:
    assert code_paths(SHARED) == []
    own = SHARED.replace("userdata: {count: 0}", "").replace("shared:", "userdata: {count: 0}\n        shared:")
    assert code_paths(own) == []


def test_a_shared_key_is_defined_around_the_branches() -> None:
    reported = code_paths(SHARED.replace("userdata: {count: 0}", ""))
    assert set(reported) == {"maybe-undefined-key root", "maybe-undefined-key root/a", "maybe-undefined-key root/b"}
    assert code_paths(SHARED.replace("shared: [count]", "shared: [count, cuont]")) == ["undefined-key root"]


def test_what_a_branch_shares_may_be_of_another_kind_for_the_others() -> None:
    """Without `shared` the reader has the number of the beginning."""
    adding = '{state: flow.SetValue, with: {value: "${count + 1}"}, out: {value: count}}'
    text = SHARED.replace(f"b: {adding}", "%s").replace('value: "${count + 1}"', "value: [1]")
    reads = "b: {state: flow.Wait, with: {duration_s: '${count}'}}"
    assert code_paths(text % reads) == ["maybe-type-mismatch root/b"]
    assert code_paths(text.replace("shared: [count]", "") % reads) == ["sibling-read root/b"]


def test_a_parallel_of_a_tree_has_branches_too() -> None:
    """The same rules hold there."""
    text = """
    userdata: {count: 0}
    root:
      machine:
        initial: tree
        states:
          tree:
            tree:
              parallel:
                - {state: flow.SetValue, with: {value: 1}, out: {value: count}, name: a}
                - {state: flow.Log, with: {message: "${string(count)}"}, name: b}
            transitions: {success: good}
    """
    assert code_paths(text) == ["sibling-read root/tree/parallel/b"]


def test_each_round_of_a_foreach_has_a_scope_of_its_own() -> None:
    """Item and index are known inside only; what is collected is defined outside if there was a round."""
    text = """
    parameters: {parts: {type: list, default: []}}
    root:
      machine:
        initial: each
        states:
          each:
            foreach:
              items: "${parts}"
              as: part
              index: number
              collect: {name: names}
              child: {state: flow.SetValue, with: {value: "${string(part)} ${number}"}, out: {value: name}}
            transitions: {exhausted: use, broken: bad}
          use: {state: flow.Log, with: {message: "${names[0]}"}, transitions: {done: good}}
    """
    assert code_paths(text) == ["maybe-undefined-key root/use"]
    assert code_paths(text.replace('items: "${parts}"', "items: [a, b]").replace("parameters", "userdata")) == []
    assert code_paths(text.replace("${names[0]}", "${part}")) == ["undefined-key root/use"]
    assert code_paths(text.replace("collect: {name:", "collect: {nmae:"))[0] == "undefined-key root/each"


def test_a_tree_goes_on_where_a_status_leads() -> None:
    """Behind a success in a sequence the key is defined; after a failure, in a selector, it is not."""
    tree = f"""
    root:
      tree:
        %s:
          - {READ}}}
          - {USE}}}
    """
    head = "flexcell: 1\nname: test\noutcomes: [success, failure]\n"
    assert code_paths(head + tree.replace("\n    ", "\n") % "sequence") == []
    assert code_paths(head + tree.replace("\n    ", "\n") % "selector") == ["undefined-key root/selector/Log"]


def test_a_timeout_may_come_before_anything_is_written() -> None:
    """What a container would have written is then perhaps not there."""
    text = f"""
    root:
      machine:
        initial: inner
        states:
          inner:
            tree: {{timeout: {{after: 1 s, child: {{state: flow.Wait, with: {{duration_s: 2}}}}}}}}
            transitions: {{success: read, failure: use}}
          read: {READ}, transitions: {{found: use, missing: bad}}, timeout: {{after: 1 s, to: use}}}}
          use: {USE}, transitions: {{done: good}}}}
    """
    assert code_paths(text) == ["maybe-undefined-key root/use"]


def test_an_unknown_state_may_write_anything() -> None:
    """Then nothing is said of keys that nobody seems to write."""
    text = f"""
    root:
      machine:
        initial: read
        states:
          read: {{state: camera.Find, transitions: {{done: use}}}}
          use: {USE}, transitions: {{done: good}}}}
    """
    assert code_paths(text) == ["unknown-state root/read"]


def test_a_reference_gives_back_only_what_out_names(tmp_path: Path) -> None:
    """Keys of the other behavior are its own; what `in` maps must be defined here."""
    part = """
    userdata: {name: hca}
    root:
      machine:
        initial: say
        states: {say: {state: flow.Log, with: {message: "${name}"}, transitions: {done: good}}}
    """
    main = """
    root:
      machine:
        initial: sub
        states:
          sub: {behavior: part.yaml, in: {name: other}, out: {name: found}, transitions: {good: use, bad: bad}}
          use: {state: flow.Log, with: {message: "${found} ${name}"}, transitions: {done: good}}
    """
    found = findings_in_files(tmp_path, part=part, main=main)
    assert [(f.code, f.path) for f in found] == [("undefined-key", "root/sub"), ("undeclared-name", "root/use")]
