# SPDX-License-Identifier: MIT
"""Why a pixel has its colour."""

import glint
from support import BALL, TestCase


class Explaining(TestCase):
    def test_a_pixel_of_the_ball(self):
        scene = glint.Scene.from_string(BALL.replace("<light>", "<samples>4</samples><light>", 1))
        image = scene.render()
        why = scene.explain(9, 4)
        self.assertEqual((why.x, why.y, len(why.samples)), (9, 4, 4))
        self.assertEqual(why.color, tuple(image.pixels[4, 9, c] for c in range(3)))
        self.assertEqual(why.rgb, tuple(image.rgb8()[4, 9, c] for c in range(3)))
        sample = why.samples[0]
        (ray,) = sample.rays
        self.assertEqual((ray.kind.name, ray.end.name, ray.surface), ("CAMERA", "SURFACE", 1))
        self.assertIsNone(ray.parent)
        self.assertEqual(len(sample.lights), 2)
        self.assertEqual(sample.lights[0].fate, glint.LightFate.ARRIVES)
        self.assertEqual(len(ray.point), 3)
        self.assertEqual(sample.additions[-1].sum, sample.color)

    def test_refusals(self):
        scene = glint.Scene.from_string(BALL)
        with self.assertRaises(glint.GlintError):
            scene.explain(16, 0)
        with self.assertRaises(glint.GlintError):
            scene.explain(0, -1)
