"""Python functions that the engine calls, and what they raise."""

import logging
import os
import signal
import threading
import weakref

import pytest
from scenes import ball, endless, pill

import pellicle


class Oops(Exception):
    pass


def test_progress_is_told_after_every_iteration():
    seen = []
    surface = pellicle.extract(ball(), 0.5, levels=1, progress=seen.append)
    assert len(seen) == sum(level.iterations for level in surface.levels)
    assert seen[0].level == 1 and seen[0].iteration == 1 and seen[-1].level == 0
    fractions = [p.fraction for p in seen]
    assert fractions == sorted(fractions) and 0 <= fractions[0] <= fractions[-1] <= 1
    assert seen[-1].vertices == surface.vertex_count
    assert seen[-1].seconds >= seen[0].seconds >= 0


def test_what_progress_returns_is_not_looked_at():
    surface = pellicle.extract(ball(), 0.5, progress=lambda p: True)
    assert surface.hash == pellicle.extract(ball(), 0.5).hash


def raiser(error, after=0):
    calls = []

    def function(*arguments):
        calls.append(arguments)
        if len(calls) > after:
            raise error

    return function


@pytest.mark.parametrize("name", ["progress", "level", "extra_force"])
@pytest.mark.parametrize("error", [Oops("here"), pellicle.Cancelled("enough"), SystemExit(3)])
def test_an_exception_in_a_callback_comes_out_of_the_call(name, error):
    after = 2 if name != "level" else 0
    with pytest.raises(type(error)) as caught:
        pellicle.extract(ball(), 0.5, levels=1, **{name: raiser(error, after)})
    assert caught.value is error
    assert any(entry.name == "function" for entry in caught.traceback)


def test_an_exception_at_the_end_of_the_last_level_comes_out_too():
    def last(report, surface):
        if report.level == 0:
            raise Oops

    with pytest.raises(Oops):
        pellicle.extract(ball(), 0.5, levels=1, level=last)


def test_a_run_goes_on_after_an_exception():
    pyramid = pellicle.Pyramid(pellicle.Volume(ball()), 0.5, levels=1)
    expected = pellicle.Run(pyramid).finish().hash
    counts = {"left": 4}

    def stop_at_times(progress):
        counts["left"] -= 1
        if counts["left"] in (0, -5):
            raise Oops

    run = pellicle.Run(pyramid, progress=stop_at_times)
    for _ in range(2):
        with pytest.raises(Oops):
            run.finish()
        assert not run.done and run.surface().check().valid
    state = run.save()
    assert run.finish().hash == expected
    assert pellicle.Run.restore(pyramid, state).finish().hash == expected


def test_a_run_tells_where_it_was_stopped():
    pyramid = pellicle.Pyramid(pellicle.Volume(ball()), 0.5, levels=1)
    seen = []

    def stop_at_the_fifth(progress):
        seen.append(progress)
        if len(seen) == 5:
            raise Oops

    run = pellicle.Run(pyramid, progress=stop_at_the_fifth)
    assert run.progress.iteration == 0
    with pytest.raises(Oops):
        run.finish()
    assert not run.done and not run.between_levels
    assert (run.progress.level, run.progress.iteration) == (1, 5)
    assert run.progress.vertices == seen[-1].vertices == run.surface().vertex_count
    # So does one that was saved there.
    restored = pellicle.Run.restore(pyramid, run.save())
    assert (restored.progress.level, restored.progress.iteration) == (1, 5)
    assert not restored.done
    run.finish()
    assert run.done and pellicle.Run.restore(pyramid, run.save()).done


def test_an_interrupt_ends_an_extraction_that_has_no_callbacks():
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        pellicle.extract(ball(40, 14), 0.5, levels=0, **endless())
    timer.join()


def test_an_interrupt_ends_the_wait_for_a_context():
    context = pellicle.Context()
    started, stop = threading.Event(), threading.Event()

    def watch(progress):
        started.set()
        if stop.is_set():
            raise Oops

    def work():
        with pytest.raises(Oops):
            pellicle.extract(ball(), 0.5, context=context, progress=watch, **endless())

    worker = threading.Thread(target=work)
    worker.start()
    started.wait()
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        pellicle.extract(ball(), 0.5, context=context)
    stop.set()
    worker.join()
    timer.join()


def test_level_validates_and_sees_the_surface():
    seen = []

    def validate(report, surface):
        assert surface.check().valid
        seen.append((report.level, surface.vertex_count, surface.vertices.shape, surface.hash))
        assert report.vertices == surface.vertex_count

    surface = pellicle.extract(ball(), 0.5, levels=2, level=validate)
    assert [level for level, *_ in seen] == [2, 1, 0]
    assert seen[-1][3] == surface.hash
    assert surface.hash == pellicle.extract(ball(), 0.5, levels=2).hash


def test_level_may_stop_or_ask_for_more():
    stopped = pellicle.extract(
        ball(), 0.5, levels=2, level=lambda report, surface: "stop" if report.level == 1 else None
    )
    assert stopped.check().valid and stopped.levels[-1].level == 1
    asked = []

    def more(report, surface):
        asked.append(report.level)
        return "more" if len(asked) == 1 else "accept"

    pellicle.extract(ball(), 0.5, levels=1, level=more)
    assert asked == [1, 1, 0]
    with pytest.raises(ValueError, match="'accept', 'more', 'stop'"):
        pellicle.extract(ball(), 0.5, level=lambda report, surface: "go")


def test_the_surface_of_a_level_is_gone_afterwards():
    kept = []
    pellicle.extract(ball(), 0.5, levels=0, level=lambda report, surface: kept.append(surface))
    for use in (
        lambda s: s.vertices, lambda s: s.vertex_count, lambda s: s.hash, lambda s: s.check(),
        lambda s: s.levels,
    ):
        with pytest.raises(ValueError, match="gone"):
            use(kept[0])


def test_a_callback_may_not_use_its_own_context_but_any_other():
    context = pellicle.Context()
    earlier = pellicle.extract(ball(), 0.5, context=context)
    errors = []

    def inside(progress):
        try:
            earlier.measures()
        except ValueError as error:
            errors.append(str(error))
        assert pellicle.check_mesh((earlier_vertices, earlier_faces)).valid

    earlier_vertices, earlier_faces = earlier.vertices, earlier.faces
    pellicle.extract(ball(), 0.5, levels=0, context=context, progress=inside)
    assert errors and all("in use" in error for error in errors)
    assert earlier.measures().components == 1


def test_what_goes_during_a_call_is_freed_after_it():
    context = pellicle.Context()
    held = [pellicle.Volume(pill(), copy=True, context=context)]
    before = context.memory.now
    pellicle.extract(ball(), 0.5, levels=0, context=context, progress=lambda p: held.clear())
    assert context.memory.now <= before - pill().nbytes


def test_callbacks_are_let_go():
    class Watch:
        def __call__(self, progress):
            pass

    watch = Watch()
    alive = weakref.ref(watch)
    surface = pellicle.extract(ball(), 0.5, progress=watch)
    run = pellicle.Run(pellicle.Pyramid(pellicle.Volume(ball()), 0.5), progress=watch)
    run.iterate()
    del watch
    assert alive() is not None
    del run
    assert alive() is None and surface.vertex_count > 0


def test_a_force_of_another_shape_is_refused():
    for wrong in ([1, 2], [[1, 2, 3]] * 2):
        with pytest.raises(ValueError, match="must return an array of shape"):
            pellicle.extract(ball(), 0.5, levels=0, extra_force=lambda points: wrong)
    with pytest.raises(pellicle.InvalidArgument):
        pellicle.extract(ball(), 0.5, levels=0, extra_force=lambda points: (float("nan"), 0, 0))


def test_the_log_goes_to_a_function_or_to_logging(caplog):
    lines = []
    context = pellicle.Context(log=lambda level, line: lines.append((level, line)))
    pellicle.extract(ball(), 0.5, context=context)
    assert lines and {level for level, _ in lines} <= {"info", "warning"}
    assert all(line and "\n" not in line for _, line in lines)
    with caplog.at_level(logging.INFO, logger="pellicle"):
        pellicle.extract(ball(), 0.5)
    assert [record.getMessage() for record in caplog.records if record.name == "pellicle"]


def test_an_exception_in_the_log_comes_out_of_the_call():
    context = pellicle.Context(log=raiser(Oops("log")))
    with pytest.raises(Oops):
        pellicle.extract(ball(), 0.5, context=context)


def test_callbacks_must_be_callable():
    for name in ("progress", "level", "extra_force"):
        with pytest.raises(TypeError, match=f"{name}: must be callable"):
            pellicle.extract(ball(), 0.5, **{name: 3})
    with pytest.raises(TypeError, match="levels="):
        pellicle.extract(ball(), 0.5, level=0)
