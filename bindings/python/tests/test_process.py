# SPDX-License-Identifier: MIT
"""Threads, forks, other processes, interrupts, interpreters, memory."""

import _thread
import gc
import multiprocessing
import os
import pathlib
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import narc

SANITIZED = "asan" in os.environ.get("LD_PRELOAD", "")


def in_threads(count, call):
    """What calls in threads return, or the error."""
    def run():
        try:
            answers.append(call())
        except Exception as error:
            answers.append(error)

    answers: list = []
    threads = [threading.Thread(target=run) for _ in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return answers


@pytest.fixture
def heap(random):
    shapes = narc.Shapes()
    box = shapes.regular(30, 1.0, 0.01)
    return shapes, narc.bodies(random.random((3000, 2)) * 9, random.random(3000) * 7, box)


def test_python_runs_meanwhile_and_shapes_are_guarded(heap, random):
    shapes, bodies = heap
    pairs = random.integers(0, 3000, (100000, 2)).astype(np.uint32)
    seen, errors = [], []

    def ask():
        for _ in range(100):
            seen.append(narc.separations(shapes, bodies, pairs).tobytes())
            if errors:  # or this thread had been quicker than the other one began
                break

    threads = [threading.Thread(target=ask) for _ in range(2)]
    for thread in threads:
        thread.start()
    while any(thread.is_alive() for thread in threads):
        try:
            shapes.circle(1 + len(errors))
        except RuntimeError as error:
            errors.append(str(error))
    assert len(set(seen)) == 1
    assert errors and set(errors) == {"shapes is in use by another call"}


def test_threads_may_read_an_index_at_a_time_but_not_step_contacts(heap, random):
    shapes, bodies = heap[0], heap[1][:1000].copy()
    index, contacts = narc.Index(shapes, bodies), narc.Contacts("contacts")
    points = random.random((3000, 2)) * 9
    expected = index.nearest(points).tobytes()
    assert [answer.tobytes() for answer in in_threads(4, lambda: index.nearest(points, threads=3))] == [expected] * 4
    first = contacts.update(shapes, bodies)
    for _ in range(50):
        answers = in_threads(4, lambda: contacts.update(shapes, bodies))
        steps = [answer for answer in answers if isinstance(answer, narc.Step)]
        assert {str(answer) for answer in answers if not isinstance(answer, narc.Step)} <= {"contacts is in use by another call"}
        assert steps and all((step.pairs == first.pairs).all() and (step.rows == first.rows).all() for step in steps)
        if len(steps) < 4:
            break


def answer(shapes, bodies, threads=2):
    return narc.manifolds(shapes, bodies, threads=threads)[0].tobytes()


def test_a_child_of_a_fork_goes_on(scene, heap):
    before = answer(scene.shapes, scene.bodies)
    busy = threading.Thread(target=lambda: [answer(heap[0], heap[1][:1000].copy(), 3) for _ in range(2 if SANITIZED else 20)])
    busy.start()  # its threads are not the child's
    for _ in range(5):
        child = os.fork()
        if child == 0:
            same = all(answer(scene.shapes, scene.bodies, threads) == before for threads in (1, 2, 5))
            heap[0].circle(3)  # which a thread of the parent may read
            os._exit(0 if same else 1)
        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
        assert answer(scene.shapes, scene.bodies) == before
    busy.join()


@pytest.mark.parametrize("method", ["spawn", "fork"])
def test_other_processes_answer(scene, method):
    expected = [answer(scene.shapes, scene.bodies[k::3].copy()) for k in range(3)]
    with multiprocessing.get_context(method).Pool(2) as pool:
        assert pool.starmap(answer, [(scene.shapes, scene.bodies[k::3].copy()) for k in range(3)]) == expected


def test_objects_are_pickled(scene):
    index = narc.Index(scene.shapes, scene.bodies, category=np.arange(1, 301, dtype=np.uint64))
    points = scene.bodies["xy"][:20] + 0.3
    again = pickle.loads(pickle.dumps(index))
    assert again.nearest(points, mask=4).tobytes() == index.nearest(points, mask=4).tobytes()
    contacts = narc.Contacts("contacts", user="f4")
    assert len(pickle.loads(pickle.dumps(contacts)).update(scene.shapes, scene.bodies).rows) > 0
    step = contacts.update(scene.shapes, scene.bodies, margin=0.1)
    contacts.keep(step.slots, np.arange(len(step.slots)))
    copied = pickle.loads(pickle.dumps(contacts))
    assert (copied.user(step.slots) == np.arange(len(step.slots))).all() and repr(copied) == repr(contacts)
    scene.bodies["xy"] += np.arange(600).reshape(-1, 2) % 7 * 0.05
    one, other = (c.update(scene.shapes, scene.bodies, margin=0.1) for c in (contacts, copied))
    assert one.rows.tobytes() == other.rows.tobytes() and one.ended.tobytes() == other.ended.tobytes()


@pytest.mark.parametrize("threads", [1, 3])
def test_slices_are_one_answer(heap, random, monkeypatch, threads):
    shapes, bodies = heap
    index = narc.Index(shapes, bodies)
    points, turn = random.random((600, 2)) * 5, random.random(600) * 7
    pairs = random.integers(0, 3000, (600, 2))
    motion = np.stack([np.cos(turn), np.sin(turn)], 1)
    some = random.integers(0, 3000, 600)

    def ask():
        return [narc.contacts(shapes, bodies, pairs, threads=threads), narc.contacts(shapes, bodies, pairs, margins=turn.astype("f4")),
                narc.contacts(shapes, bodies, pairs, dense=True), narc.manifolds(shapes, bodies, pairs, margin=0.5),
                narc.overlaps(shapes, bodies, pairs, threads=threads), narc.separations(shapes, bodies, pairs, threads=threads),
                index.rays(points, motion, fraction=turn / 7, ignored=some, owners={"owner": np.arange(3000), "ignored": some}),
                index.rays((1, 2), motion, most=3), index.nearest(points, most=2, ignored=some), narc.inside(shapes, bodies, points, some),
                narc.distances(shapes, bodies, points, some), narc.rays(shapes, bodies, points, motion, some),
                index.casts(bodies[:160], motion[:160], turn[:160], ignored=np.arange(160))]

    whole = ask()
    monkeypatch.setattr(narc._batch, "SLICE", 100)
    monkeypatch.setattr(narc._scene, "SLICE", 100)
    for k, (part, one) in enumerate(zip(ask(), whole)):
        assert part.tobytes() == one.tobytes(), k
    with pytest.raises(ValueError, match="body has 5 items, where there are 600"):
        narc.distances(shapes, bodies, points, some[:5])


def test_ctrl_c_ends_a_long_call(heap, random, ctrl_c):
    shapes, bodies = heap
    pairs = random.integers(0, 3000, (4_000_000, 2), dtype=np.uint32)
    begin = time.perf_counter()
    timer = threading.Timer(0.3, _thread.interrupt_main, [signal.SIGINT])
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        for _ in range(200):
            narc.separations(shapes, bodies, pairs)
    timer.join()
    assert shapes.circle(2) == 1 and time.perf_counter() - begin < 60


def ask_all(shapes, bodies, index, contacts):
    pairs = np.array([[0, 1], [2, 3]])
    narc.contact(shapes, bodies[0], bodies[1], margin=9)
    narc.contacts(shapes, {"xy": bodies["xy"], "shape": bodies["shape"]}, pairs, margin=1, margins=[1.0, 2.0])
    index.nearest([[0, 0]], most=2)
    contacts.update(shapes, bodies)
    new = narc.Shapes()
    new.box(2, 1)
    for call in (lambda: new.circle(-1), lambda: narc.overlaps(shapes, bodies, [[0, 999]]), lambda: new.arcs(4),
                 lambda: narc.contacts(shapes, {"xy": bodies["xy"], "cosine": np.ones(3)}, pairs)):
        with pytest.raises((narc.Error, TypeError)):
            call()


@pytest.mark.skipif(SANITIZED, reason="the sanitizer holds back what is freed")
def test_memory_does_not_grow(scene):
    bodies = scene.bodies[:20].copy()
    index, contacts = narc.Index(scene.shapes, bodies), narc.Contacts()
    used = []
    for _ in range(3):  # 1e5 calls
        for _ in range(3000):
            ask_all(scene.shapes, bodies, index, contacts)
        gc.collect()
        used.append(int(pathlib.Path("/proc/self/statm").read_text().split()[1]))
    assert used[2] - used[1] < 64  # pages


def test_references_are_given_back(scene):
    """Of all that calls are given, and of what a list is made into, right or wrong."""
    bodies, pairs, motion = scene.bodies, np.array([[0, 1]], np.uint32), np.zeros((300, 2), np.float32)
    columns = {name: bodies[name].copy() for name in bodies.dtype.names}
    kept = [scene.shapes, bodies, pairs, motion, columns, *columns.values(), narc.CONTACT, narc.BODY]
    index = narc.Index(scene.shapes, bodies)

    def ask():
        narc.contacts(scene.shapes, bodies, pairs), narc.contacts(scene.shapes, columns, pairs, margins=[0.5])
        index.casts(columns, motion, threads=2)
        for wrong in ({**columns, "shape": motion}, {**columns, "scale": pairs}, {**columns, "colour": pairs}):
            with pytest.raises((TypeError, ValueError)):
                narc.contacts(scene.shapes, wrong, pairs)

    ask()
    before = [sys.getrefcount(thing) for thing in kept]
    for _ in range(100):
        ask()
    assert [sys.getrefcount(thing) for thing in kept] == before


def test_modules_are_loaded_again():
    code = "import importlib, narc, os\nfor _ in range(9): importlib.reload(narc._tables)\n" \
           "narc.validate(narc.Shapes(), narc._tables.np.zeros(0, narc._tables.BODY))\n" \
           "child = os.fork()\nif child: assert os.waitpid(child, 0)[1] == 0"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_subinterpreters_are_refused():
    interpreters = pytest.importorskip("_xxsubinterpreters")
    other = interpreters.create()
    try:
        with pytest.raises(interpreters.RunFailedError, match="subinterpreters"):
            interpreters.run_string(other, "from importlib.util import module_from_spec, spec_from_file_location as find\n"
                                    f"spec = find('narc._narc', {narc._narc.__file__!r})\nspec.loader.exec_module(module_from_spec(spec))")
    finally:
        interpreters.destroy(other)


def test_two_threads_fork_at_a_time():
    code = """if True:
        import os, signal, threading, time
        slow = threading.local()
        os.register_at_fork(before=lambda: time.sleep(getattr(slow, "time", 0)))  # behind the package's own
        import narc
        shapes = narc.Shapes()
        shapes.box(2, 1)
        bodies = narc.bodies([[0.3 * k, 0] for k in range(500)])
        done = []

        def fork(seconds, ask):
            slow.time = seconds
            child = os.fork()
            if child == 0:
                signal.alarm(60)
                if ask:
                    narc.contacts(shapes, bodies, threads=9)
                os._exit(0)
            done.append(os.waitpid(child, 0)[1])

        def work():
            while len(done) < 12:
                narc.contacts(shapes, bodies, threads=4)

        busy = threading.Thread(target=work)
        busy.start()
        for _ in range(6):
            both = [threading.Thread(target=fork, args=a) for a in ((0.05, False), (0.15, True))]
            both[0].start()
            time.sleep(0.01)
            both[1].start()
            for one in both:
                one.join()
        busy.join()
        assert done == [0] * 12, done
    """
    subprocess.run([sys.executable, "-c", code], check=True)
