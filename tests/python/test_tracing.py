# SPDX-License-Identifier: MIT
"""What rays meet."""

import math
import random

import glint
from support import BALL, TestCase, needs_numpy, values

DOWN = (0, 0, -1)


class Tracing(TestCase):
    def setUp(self):
        super().setUp()
        self.scene = glint.Scene.from_string(BALL)

    def test_one(self):
        hit = self.scene.trace((0, 0, 5), (0, 0, -2))
        self.assertEqual((hit.t, hit.point, hit.normal), (2, (0, 0, 1), (0, 0, 1)))
        self.assertEqual((hit.surface, hit.shader), (1, 0))
        self.assertIsNone(self.scene.trace((0, 2, 5), DOWN))
        self.assertIsNone(self.scene.trace((0, 0, 5), DOWN, 0, 3.5))
        self.assertEqual(self.scene.trace((0, 0, 5), DOWN, 4.5).t, 6)
        self.assertTrue(self.scene.occluded((0, 0, 5), DOWN))
        self.assertFalse(self.scene.occluded((0, 0, 5), DOWN, t_max=3.5))

    def test_many(self):
        origins = [[0, 0, 5], [0, 2, 5], [0.6, 0, 5]]
        hits = self.scene.trace_rays(origins, DOWN)
        self.assertEqual(len(hits), 3)
        self.assertEqual(values(hits.t)[:2], [4, math.inf])
        self.assertEqual(values(hits.surface), [1, 0, 1])
        self.assertEqual(values(hits.point)[0], [0, 0, 1])
        self.assertAlmostEqual(hits.normal[2, 2], 0.8)
        self.assertEqual(values(hits.shader), [0, 0, 0])
        self.assertEqual(values(self.scene.occluded_rays(origins, DOWN)), [True, False, True])
        limited = self.scene.trace_rays(origins, DOWN, t_max=[3, 9, 9])
        self.assertEqual(values(limited.surface), [0, 0, 1])
        self.assertEqual(len(self.scene.trace_rays((0, 0, 5), DOWN)), 1)

    def test_many_are_single_ones(self):
        numbers = random.Random(1)
        point = lambda: [numbers.uniform(-2, 2) for _ in range(3)]
        origins, directions = [point() for _ in range(500)], [point() for _ in range(500)]
        hits = self.scene.trace_rays(origins, directions)
        for i, (origin, direction) in enumerate(zip(origins, directions)):
            hit = self.scene.trace(origin, direction)
            self.assertEqual(hit is not None, hits.t[i] < math.inf)
            if hit is not None:
                self.assertEqual((hit.t, hit.point[1]), (hits.t[i], hits.point[i, 1]))

    @needs_numpy
    def test_arrays(self):
        import numpy

        origins = numpy.zeros((1000, 3))
        origins[:, 2] = 5
        hits = self.scene.trace_rays(origins, numpy.array(DOWN), t_max=numpy.full(1000, 9.0))
        self.assertTrue((hits.t == 4).all())
        self.assertEqual(hits.normal.shape, (1000, 3))
        self.assertEqual(len(self.scene.trace_rays(numpy.zeros((0, 3)), DOWN)), 0)
        with self.assertRaises(ValueError):
            self.scene.trace_rays(numpy.zeros((2, 2, 3)), DOWN)

    def test_refusals(self):
        nan, inf = math.nan, math.inf
        for what, arguments in (
            ("no length", ((0, 0, 0), (0, 0, 0))),
            ("direction", ((0, 0, 0), (0, 0, nan))),
            ("direction", ((0, 0, 0), (0, 0, inf))),
            ("origin", ((0, nan, 0), DOWN)),
            ("t_min", ((0, 0, 0), DOWN, nan)),
            ("3 numbers|three numbers", ((0, 0), DOWN)),
        ):
            for call in (self.scene.trace, self.scene.occluded):
                with self.subTest(what), self.assertRaisesRegex(ValueError, what):
                    call(*arguments)
            with self.subTest(what), self.assertRaises(ValueError):
                self.scene.trace_rays(*arguments)
        with self.assertRaises(ValueError):
            self.scene.trace_rays([[0, 0, 5]] * 2, [DOWN] * 3)
