"""Tests of the Python client with a service, a service with a key, and the program.

tests/clients/clients.test.mjs starts them and passes their addresses in the environment.
"""

from __future__ import annotations

import csv
import json
import math
import os
import pathlib
import pickle
import signal
import subprocess
import sys
import tempfile
import unittest
import unittest.mock
import warnings

import vines

PROGRAM = os.environ["VINES_PROGRAM"]
SERVICE = os.environ["TEST_SERVICE"]
LOCKED = os.environ["TEST_LOCKED"]
KEY = os.environ["TEST_KEY"]
RECORD = os.environ["TEST_RECORD"]

BOTH = {"service": vines.Service(SERVICE), "program": vines.Program(PROGRAM)}
LINE = {"parameter": "b", "from": 0.01, "to": 0.05, "count": 12}

try:
    import pandas
except ImportError:
    pandas = None


class WithBothClients(unittest.TestCase):
    def each(self):
        for name, client in BOTH.items():
            with self.subTest(client=name):
                yield client


class Answers(WithBothClients):
    def test_a_run_has_lists_as_arrays_and_parts_as_attributes(self):
        for client in self.each():
            run = client.simulate(b=0.022, tau_end=200, include=["impacts", "exponents"])
            self.assertEqual(run.status.reason, "tau_end")
            self.assertEqual(run["status.reason"], "tau_end")
            self.assertEqual(len(run.impacts.tau), len(run["impacts"]["side"]))
            self.assertTrue(0 < run.impacts.tau[0] < run.impacts.tau[-1] <= 200)
            self.assertEqual(run.parameters.b, 0.022)

    def test_null_in_a_list_of_numbers_is_nan_and_is_written_as_null(self):
        for client in self.each():
            moduli = client.simulate(tau_end=100, include=["eigenvalues"]).eigenvalues
            self.assertTrue(all(isinstance(float(v), float) for v in moduli.M_condition))
            run = client.simulate(tau_end=1e-3, include=["exponents"])
            final = run.exponents.qr.final
            self.assertTrue(final is None or any(math.isnan(v) for v in final) or len(final) == 4)
            self.assertNotIn("NaN", repr(run.plain()))

    def test_service_and_program_give_the_same_numbers(self):
        one, other = (
            client.simulate(preset="fig11", tau_end=300).plain() for client in BOTH.values()
        )
        for answer in (one, other):
            answer.pop("provenance")
        self.assertEqual(one, other)

    def test_a_saved_answer_is_the_received_text_and_verifies(self):
        with tempfile.TemporaryDirectory() as folder:
            for client in self.each():
                file = pathlib.Path(folder, "run.json")
                run = client.simulate(preset="fig3", tau_end=100, include=["impacts"])
                pickle.loads(pickle.dumps(run)).save(file)
                subprocess.run([PROGRAM, "verify", file], check=True, capture_output=True)
                self.assertEqual(json.loads(file.read_bytes()), run.plain())
                self.assertTrue(file.read_bytes().endswith(b"}\n"))
                client.identify(RECORD, preset="fig20", b=0.015).save(str(file))
                verify = [PROGRAM, "verify", file, "--record", RECORD]
                subprocess.run(verify, check=True, capture_output=True)
                with self.assertRaisesRegex(ValueError, "save the whole answer"):
                    run.impacts.save(file)
                with self.assertRaisesRegex(ValueError, "run.npz: answers are saved as JSON"):
                    run.save("run.npz")

    def test_the_error_of_an_invalid_request_names_its_fields(self):
        for client in self.each():
            with self.assertRaises(vines.Problem) as caught:
                client.simulate(b=-1, Omga=2)
            self.assertEqual(caught.exception.status, 422)
            self.assertEqual([e.field for e in caught.exception.errors], ["b", "Omga"])
            self.assertEqual(caught.exception.errors[0].value, -1)

    def test_a_run_that_ends_early_gives_an_answer_and_a_warning(self):
        for client in self.each():
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                run = client.simulate(max_impacts=5)
            self.assertEqual(run.status.reason, "max_impacts")
            self.assertEqual([w.category for w in caught], [vines.PartialAnswer])
            self.assertEqual(caught[0].filename, __file__)

    def test_a_deadline_is_reported(self):
        with self.assertWarns(vines.PartialAnswer):
            run = vines.Service(LOCKED, key=KEY).simulate(
                b=0.003, R=1, tau_end=1e7, max_impacts=2000000, include=["exponents"]
            )
        self.assertEqual(run.status.reason, "deadline")

    def test_no_method_hides_a_key_of_an_answer(self):
        for client in self.each():
            whole = client.simulate(preset="fig20", tau_end=400)
            todo = [whole]
            while todo:
                answer = todo.pop()
                for name in answer:
                    if not hasattr(vines.Answer, name):
                        value = getattr(answer, name)
                        self.assertIs(value, answer[name])
                        todo += [value] if isinstance(value, vines.Answer) else []
                    else:
                        self.fail(f"{name} is also a method")

    @unittest.skipUnless(pandas, "pandas is not installed")
    def test_lists_of_equal_length_form_a_data_frame(self):
        for client in self.each():
            run = client.simulate(tau_end=200, include=["impacts"])
            frame = run.frame("impacts")
            self.assertEqual(len(frame), len(run.impacts.tau))
            self.assertIn("y_dot_after", frame.columns)
            points = client.sweep(axes=[LINE], cycles=50).frame()
            self.assertEqual(list(points.index), list(range(12)))

    def test_without_pandas_a_table_is_a_dict_of_columns(self):
        with unittest.mock.patch.dict(sys.modules, pandas=None):
            for client in self.each():
                run = client.simulate(tau_end=200, include=["impacts"])
                columns = run.frame("impacts")
                self.assertEqual(list(columns["side"]), list(run.impacts.side))
                points = client.sweep(axes=[LINE], cycles=50).frame()
                self.assertEqual(list(points["index"]), list(range(12)))
                self.assertTrue(all(v < 1 or math.isnan(v) for v in points["lambda4"]))
                self.assertEqual({len(column) for column in points.values()}, {12})


class Sweeps(WithBothClients):
    def test_a_sweep_passes_on_and_counts_its_points_as_they_arrive(self):
        for client in self.each():
            with client.sweep(axes=[LINE], cycles=50, base={"lambda": 1.4}) as sweep:
                self.assertEqual((sweep.total, sweep.done), (12, 0))
                points = list(sweep)
            self.assertEqual(sorted(p.index for p in points), list(range(12)))
            self.assertEqual((sweep.done, sweep.missing), (12, []))
            self.assertEqual(len(points[0].lambda_), 4)

    def test_an_invalid_sweep_raises_before_its_first_point(self):
        for client in self.each():
            with self.assertRaises(vines.Problem) as caught:
                client.sweep(axes=[{**LINE, "count": -3}])
            self.assertEqual(caught.exception.status, 422)

    def test_closing_a_sweep_stops_the_computation(self):
        for client in self.each():
            sweep = client.sweep(axes=[{**LINE, "count": 4000}], cycles=20000)
            next(sweep)
            sweep.close()
            self.assertEqual(list(sweep), [])
            self.assertLess(sweep.done, 4000)

    def test_an_interrupted_sweep_raises_after_its_last_point(self):
        program = vines.Program(PROGRAM, threads=1)
        sweep = program.sweep(axes=[{**LINE, "count": 4000}], cycles=20000)
        received = [next(sweep)]
        for child in pathlib.Path(f"/proc/self/task/{os.getpid()}/children").read_text().split():
            os.kill(int(child), signal.SIGTERM)
        with self.assertRaises(vines.Incomplete):
            received += sweep
        self.assertGreater(len(received), 0)
        self.assertEqual(len(sweep.missing), 4000 - sweep.done)


class Continuations(WithBothClients):
    FIELDS = {
        "base": {"b": 0.015, "damping": "closed_form"},
        "parameter": "b",
        "from_": 0.005,
        "to": 0.02,
    }

    def test_a_continuation_has_branches_points_and_special_points(self):
        for client in self.each():
            lines = list(client.continue_(**self.FIELDS, switch=1))
            types = [line.type for line in lines]
            self.assertEqual(types[0], "branch")
            self.assertGreater(types.count("point"), 50)
            kinds = {line.kind: line.b for line in lines if line.type == "special"}
            self.assertAlmostEqual(kinds["symmetry_breaking"], 7.046736303e-3, delta=1e-12)

    def test_basins_have_points_and_a_result(self):
        for client in self.each():
            basins = client.basins(
                base={"b": 0.0065, "damping": "closed_form", "y0": 0},
                box={"x0": [-0.003, 0.003], "y_dot0": [-0.02, 0.02]},
                count=60,
                pairs=0,
            )
            names = [point.attractor for point in basins]
            self.assertEqual(len(names), 60)
            one, other = basins.result.attractors
            self.assertEqual({one.attractor, other.attractor}, set(names))
            self.assertEqual(one.mirror, other.attractor)
            self.assertEqual(one.starts + other.starts, 60)

    def test_an_invalid_continuation_raises_at_once(self):
        for client in self.each():
            with self.assertRaises(vines.Problem) as caught:
                client.continue_(**{**self.FIELDS, "parameter": "q"})
            self.assertEqual(caught.exception.errors[0].field, "parameter")


class Manifolds(WithBothClients):
    def test_a_manifold_recommends_b(self):
        for client in self.each():
            self.assertGreater(client.manifold(b=0.02).manifold.recommended.b, 0)


class Designs(WithBothClients):
    FIELDS = {
        "base": {"m1": 2, "f0": 8, "damping_ratio": 0.01, "m2": 0.04},
        "f": [7.8, 8.2],
        "acceleration": 5,
        "R": 0.4,
        "b_count": 3,
        "f_count": 3,
        "starts": "one",
        "cycles": 20,
    }

    def test_a_design_has_the_best_absorber_and_its_alternatives(self):
        for client in self.each():
            done = client.design(**self.FIELDS)
            self.assertAlmostEqual(done.without.x_max, 0.0990, delta=1e-4)
            self.assertLess(done.best.x_max, done.without.x_max)
            self.assertLess(done.tuned_mass_damper.x_max, done.best.x_max)

    def test_each_absorber_and_sample_arrives_before_the_result(self):
        tolerances = {"R": {"uniform": [0.35, 0.45]}}
        for client in self.each():
            lines = []
            done = client.design(
                lines.append, **self.FIELDS, tolerances=tolerances, samples=3, seed=1
            )
            points = [line for line in lines if line.type == "point"]
            samples = [line for line in lines if line.type == "sample"]
            self.assertIn(done.best.x_max, [point.x_max for point in points])
            self.assertEqual({sample.index for sample in samples}, {0, 1, 2})

    def test_an_error_with_a_point_stops_the_design(self):
        for client in self.each():
            with self.assertRaises(ZeroDivisionError):
                client.design(lambda line: 1 / 0, **self.FIELDS)

    def test_an_invalid_design_raises_at_once(self):
        for client in self.each():
            with self.assertRaises(vines.Problem) as caught:
                client.design(**{**self.FIELDS, "R": 2})
            self.assertEqual(caught.exception.errors[0].field, "R/0")


class Identifications(WithBothClients):
    def test_a_file_and_its_columns_give_the_same_identification(self):
        with open(RECORD, newline="") as file:
            rows = [row for row in csv.reader(file) if row]
        columns = {name: [float(row[k]) for row in rows[1:]] for k, name in enumerate(rows[0])}
        for client in self.each():
            of_file = client.identify(RECORD, preset="fig20", b=0.015)
            of_columns = client.identify(columns, preset="fig20", b=0.015)
            self.assertEqual(len(of_file.impacts.tau), len(of_columns.impacts.tau))
            self.assertGreater(len(of_file.impacts.tau), 10)
            self.assertAlmostEqual(
                of_file.restitution.plus.R, of_columns.restitution.plus.R, places=6
            )

    def test_impacts_of_a_run_are_accepted_as_a_measurement(self):
        for client in self.each():
            run = client.simulate(b=0.015, R=0.7, tau_end=300, include=["impacts"])
            found = client.identify(impacts=run.impacts, b=0.015)
            self.assertAlmostEqual(found.restitution.plus.R, 0.7, places=9)

    def test_a_missing_file_is_an_os_error(self):
        for client in self.each():
            with self.assertRaises(FileNotFoundError):
                client.identify("/nowhere/record.csv", preset="fig20")


class ClientChoice(unittest.TestCase):
    def test_the_key_is_sent_if_there_is_one(self):
        with self.assertRaises(vines.Problem) as caught:
            vines.Service(LOCKED).simulate(tau_end=20)
        self.assertEqual(caught.exception.status, 401)
        self.assertEqual(
            vines.Service(LOCKED, key=KEY).simulate(tau_end=20).status.reason, "tau_end"
        )
        self.assertNotIn(KEY, repr(vines.Service(LOCKED, key=KEY)))

    def test_the_environment_chooses_the_client(self):
        line = "import vines; print(vines.client(), vines.simulate(tau_end=20).status.reason)"
        for environment, client_type in (
            ({"VINES_URL": LOCKED, "VINES_KEY": KEY}, "Service"),
            ({"VINES_PROGRAM": PROGRAM}, "Program"),
        ):
            kept = {n: v for n, v in os.environ.items() if not n.startswith("VINES_")}
            output = subprocess.run(
                [sys.executable, "-c", line],
                env={**kept, **environment}, capture_output=True, text=True, check=True,
            ).stdout
            self.assertTrue(output.startswith(client_type) and output.rstrip().endswith("tau_end"), output)

    def test_a_missing_service_or_program_raises(self):
        with self.assertRaises(ConnectionError):
            vines.Service("http://127.0.0.1:9").simulate(tau_end=20)
        with self.assertRaisesRegex(FileNotFoundError, "VINES_PROGRAM"):
            vines.Program("no-such-program").simulate(tau_end=20)

    def test_without_numpy_lists_are_lists(self):
        line = (
            "import sys; sys.modules['numpy'] = None\n"
            "import vines; tau = vines.simulate(tau_end=50, include=['impacts']).impacts.tau\n"
            "assert type(tau) is list and type(tau[0]) is float"
        )
        subprocess.run([sys.executable, "-c", line], check=True)


if __name__ == "__main__":
    unittest.main()
