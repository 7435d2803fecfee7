"""What programs do: values, scopes, threads, critical sections, and the limits of a program that runs wild."""

from __future__ import annotations

import pytest

from tests.robots.drivers.universal_robots.emulator.urscript_execution import execute, messages, new_controller


@pytest.mark.parametrize(
    ("expression", "text"),
    [
        ("1 + 2 * 3", "7"),
        ("(1 + 2) * 3", "9"),
        ("7 % 4", "3"),
        ("3 / 2", "1.5"),
        ("-2 + 1", "-1"),
        ("1 < 2 and 2 < 1", "False"),
        ("1 == 1 or undefined_here", "True"),
        ("not 1 == 2", "True"),
        ("True xor True", "False"),
        ("[1, 2.5, True]", "[1, 2.5, True]"),
        ("p[1, 2, 3, 0, 0, 0]", "p[1, 2, 3, 0, 0, 0]"),
        ("pose_trans(p[1,0,0,0,0,0], p[0,2,0,0,0,0])", "p[1, 2, 0, 0, 0, 0]"),
        ("pose_inv(p[1,0,0,0,0,0])", "p[-1, 0, 0, 0, 0, 0]"),
        ("norm([3, 4])", "5"),
        ("length([3, 4])", "2"),
        ("get_inverse_kin_has_solution(p[9, 0, 0, 0, 0, 0])", "False"),
        ("is_within_safety_limits([7, 0, 0, 0, 0, 0])", "False"),
    ],
)
def test_an_expression_has_its_value(expression: str, text: str) -> None:
    """As `textmsg` shows it."""
    assert messages(f"textmsg({expression})") == [text]


def test_a_name_declared_global_anywhere_is_global_and_others_are_of_their_function() -> None:
    """Also where the declaration comes later."""
    source = """
def program():
  def count():
    counter = counter + 1
    own = 5
    return own
  end
  global counter = 0
  own = 1
  count()
  count()
  textmsg(counter, ",", own)
end
"""
    assert messages(source) == ["2,1"]


def test_lists_are_copied_when_they_are_assigned() -> None:
    """An element of one does not change the other."""
    assert messages("def f():\n a = [1, 2]\n b = a\n b[0] = 9\n textmsg(a, b)\nend") == ["[1, 2][9, 2]"]


def test_a_loop_with_break_and_continue() -> None:
    """The sum of the odd numbers below ten."""
    source = """
def f():
  i = 0
  sum = 0
  while True:
    i = i + 1
    if i >= 10:
      break
    elif i % 2 == 0:
      continue
    end
    sum = sum + i
  end
  textmsg(sum)
end
"""
    assert messages(source) == ["25"]


def test_threads_run_beside_one_another_until_they_are_killed() -> None:
    """A variable that holds no thread may be killed."""
    source = """
def f():
  global ticks = 0
  thread tick():
    while True:
      ticks = ticks + 1
      sync()
    end
  end
  t = run tick()
  sleep(0.08)
  kill t
  kill 0
  before = ticks
  sleep(0.08)
  textmsg(ticks == before, before > 5)
end
"""
    assert messages(source) == ["TrueTrue"]


def test_a_critical_section_holds_while_a_motion_takes_time() -> None:
    """No other thread is executed before its end."""
    source = """
def f():
  global ticks = 0
  thread tick():
    while True:
      ticks = ticks + 1
      sync()
    end
  end
  t = run tick()
  sync()
  sync()
  enter_critical
  before = ticks
  movej([0.1, -1.57, 1.57, -1.57, -1.57, 0])
  after = ticks
  exit_critical
  sync()
  sync()
  textmsg(before == after, ticks > after)
end
"""
    assert messages(source) == ["TrueTrue"]


@pytest.mark.parametrize(
    ("source", "message"),
    [
        ("x = 1 / 0", "`/`: "),
        ("x = unknown + 1", "variable `unknown` has no value"),
        ("fly(3)", "there is no function `fly`"),
        ("movej(3)", "six numbers are expected, not 3"),
        ("x = [1, 2][5]", "has no element 5"),
        ('x = "a" + 1', "a number is expected, not a"),
        ("write_output_integer_register(99, 1)", "`address` is 99; there are 48"),
        ("def f():\n def g():\n  g()\n end\n g()\nend", "more than 30 calls in one another"),
        (f"def f():\n def g():\n{' if True:' * 25}\n g()\n{' end' * 25}\n end\n g()\nend", "ended: "),
        ("def f():\n thread g():\n  sleep(9)\n end\n while True:\n  t = run g()\n end\nend", "more than 50 threads"),
        ("def f():\n x = 2\n while True:\n  x = x * x\n end\nend", "the number is too large"),
    ],
)
def test_an_error_ends_the_program_and_says_why(source: str, message: str) -> None:
    """And the controller goes on."""
    controller = execute(source)
    assert controller.program is None
    assert message in controller.messages[-1]


def test_a_loop_that_never_waits_does_not_hold_the_controller() -> None:
    """Its cycles go on, with a part of the loop in each."""
    controller = execute("while True:\n x = 1\nend", cycles=30)
    assert controller.program is not None
    assert controller.time_s == pytest.approx(30 * 0.008)


def test_a_joint_out_of_its_range_is_a_protective_stop() -> None:
    """With the reason in the log, and the arm at rest."""
    controller = execute("movej([6.5, -1.57, 1.57, -1.57, -1.57, 0], a=8, v=2)")
    assert controller.safety.safety_mode.name == "PROTECTIVE_STOP"
    assert controller.arm.is_at_rest
    assert controller.messages[-1] == "protective stop: joint 0 would leave its range"


def test_a_stopped_controller_takes_no_program() -> None:
    """Before it is unlocked."""
    controller = new_controller()
    controller.protective_stop("test")
    execute("movej([1, -1.57, 1.57, -1.57, -1.57, 0])", controller=controller)
    assert controller.arm.q[0] == 0.0
    assert controller.messages[-1] == "program line refused: the robot cannot move"


def test_a_secondary_program_runs_beside_the_main_one() -> None:
    """And does not end it."""
    controller = new_controller()
    execute("def main():\n while True:\n  sync()\n end\nend", cycles=3, controller=controller)
    from robots.drivers.universal_robots.emulator.urscript.urscript_interpreter import UrscriptRun
    from robots.drivers.universal_robots.emulator.urscript.urscript_parser import parse_program

    controller.start_secondary(UrscriptRun(parse_program("sec s():\n set_digital_out(2, True)\nend"), controller))
    controller.run_cycle()
    assert controller.digital_outputs == 1 << 2
    assert controller.program_name == "main"
    assert controller.program is not None
