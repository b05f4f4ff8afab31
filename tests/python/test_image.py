# SPDX-License-Identifier: MIT
"""Pictures in memory and in files."""

import dataclasses
import os
import struct
import subprocess
import zlib

import glint
from support import BALL, HAS_NUMPY, SCENES, TestCase, flat, needs_numpy


def ball(**options):
    return glint.Scene.from_string(BALL, name="ball.xml", **options)


def png_rows(data):
    """Width, height and the bytes of a PNG of 8 bits whose rows are filtered in any way."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed, size = 8, b"", (0, 0)
    while at < len(data):
        (length,) = struct.unpack_from(">I", data, at)
        name, body = data[at + 4 : at + 8], data[at + 8 : at + 8 + length]
        if name == b"IHDR":
            size = struct.unpack(">II", body[:8])
        if name == b"IDAT":
            packed += body
        at += 12 + length
    stream, (width, height) = zlib.decompress(packed), size
    step, before, result = width * 3, bytes(width * 3), []
    for y in range(height):
        kind, row = stream[y * (step + 1)], bytearray(stream[y * (step + 1) + 1 :][:step])
        for i in range(step):
            left = row[i - 3] if i >= 3 else 0
            up, corner = before[i], before[i - 3] if i >= 3 else 0
            guess = left + up - corner
            paeth = min((left, up, corner), key=lambda v: abs(guess - v))
            row[i] = (row[i] + [0, left, up, (left + up) // 2, paeth][kind]) & 255
        result += row
        before = bytes(row)
    return width, height, result


class Memory(TestCase):
    def test_shapes(self):
        image = ball().render()
        self.assertEqual((image.width, image.height), (16, 12))
        self.assertEqual(tuple(image.pixels.shape), (12, 16, 3))
        self.assertGreater(image.pixels[6, 8, 0], 0)
        self.assertEqual(image.pixels[0, 0, 0], 0)
        self.assertEqual(type(image.pixels).__name__, "ndarray" if HAS_NUMPY else "memoryview")
        self.assertEqual(repr(image), "<glint.Image 16 x 12>")

    def test_other_sizes(self):
        scene = ball()
        self.assertEqual(tuple(scene.render(width=8, height=5).pixels.shape), (5, 8, 3))
        whole, part = scene.render(), scene.render(crop=(4, 3, 6, 2))
        self.assertEqual(tuple(part.pixels.shape), (2, 6, 3))
        self.assertEqual(part.pixels[1, 5, 2], whole.pixels[4, 9, 2])
        self.assertEqual(tuple(scene.render(crop=(4, 3, 0, 0)).pixels.shape), (9, 12, 3))

    def test_refusals(self):
        scene = ball()
        for options in (
            {"crop": (16, 0, 1, 1)},
            {"crop": (0, 0, 17, 1)},
            {"crop": (-1, 0, 1, 1)},
            {"crop": (0, 0, -1, 1)},
            {"width": -1},
            {"width": 1 << 20, "height": 1 << 20},
            {"samples": -1},
            {"samples": 65537},
            {"light": 3},
        ):
            with self.subTest(options), self.assertRaises(glint.GlintError) as caught:
                scene.render(**options)
            self.assertEqual(caught.exception.status, glint.Status.ERROR_ARGUMENT)
            self.assertNotIn("null", caught.exception.message)
        with self.assertRaisesRegex(ValueError, "4 numbers"):
            scene.render(crop=(1, 2))
        with self.assertRaisesRegex(ValueError, "did you mean 'depth'"):
            scene.render(layers=["dept"])

    def test_layers(self):
        image = ball().render(layers=["depth", "normal", "albedo", "surface"])
        self.assertAlmostEqual(image.depth[6, 8], 3.0, 1)
        self.assertEqual(image.depth[0, 0], 0)
        self.assertAlmostEqual(image.normal[6, 8, 2], 1.0, 1)
        self.assertEqual(image.albedo[6, 8, 0], 1)
        self.assertEqual(image.surface[6, 8], 1)
        self.assertEqual(image.surface[0, 0], 0)
        self.assertEqual(image.surface.format if not HAS_NUMPY else image.surface.dtype.char, "I")
        self.assertIn("depth, normal", repr(image))
        with self.assertRaisesRegex(AttributeError, r"no depth: render\(layers=\['depth'\]\)"):
            ball().render().depth

    def test_lights_sum_up(self):
        scene = ball()
        whole, *parts = (flat(scene.render(light=k).pixels) for k in (0, 1, 2, -1))
        for total, *shares in zip(whole, *parts):
            self.assertAlmostEqual(total, sum(shares), 6)

    @needs_numpy
    def test_numpy(self):
        import numpy

        image = ball().render()
        self.assertEqual(image.pixels.dtype, numpy.float32)
        self.assertIs(numpy.asarray(image), image.pixels)
        self.assertEqual(numpy.asarray(image, "float64").dtype, numpy.float64)

    def test_pictures_of_ones_own(self):
        image = glint.Image([[[0, 0.5, 1], [1, 1, 1]]])
        self.assertEqual((image.width, image.height), (2, 1))
        self.assertEqual(flat(image.rgb8()), [0, 186, 255, 255, 255, 255])
        for wrong in ([[0, 1]], [[[0, 1]]], 3, [[[0, 1, 2]], [[0, 1]]], "text"):
            with self.subTest(wrong), self.assertRaises((TypeError, ValueError)):
                glint.Image(wrong)
        with self.assertRaisesRegex(ValueError, "as many rows"):
            glint.Image([[[0, 0, 0]]], layers={"depth": [[1], [2]]})


class Cameras(TestCase):
    def test_the_scenes_own(self):
        scene = ball()
        self.assertEqual(scene.camera.view_point, (0, 0, 4))
        self.assertEqual(scene.camera.view_width, 1.6)
        own = scene.render(camera=scene.camera)
        self.assertEqual(bytes(own.pixels), bytes(scene.render().pixels))
        with self.assertRaisesRegex(ValueError, "no camera"):
            glint.Scene().camera

    def test_another(self):
        scene = ball()
        camera = dataclasses.replace(scene.camera, view_point=(4, 0, 0), view_direction=(-1, 0, 0))
        other = glint.Scene()
        other.set_image(16, 12)
        other.set_camera(**dataclasses.asdict(camera))
        other.add_light(position=(4, 5, 6))
        other.add_light(position=(-4, 5, 6))
        other.add_sphere()
        image = scene.render(camera=camera)
        self.assertEqual(bytes(image.pixels), bytes(other.render().pixels))
        self.assertIsNone(image.recipe)
        with self.assertRaises(glint.GlintError):
            scene.render(camera=dataclasses.replace(camera, view_width=-1))

    def test_rays(self):
        scene = ball()
        origin, direction = scene.camera.ray(0.5, 0.5)
        self.assertEqual((origin, direction), ((0, 0, 4), (0, 0, -1)))
        depth = scene.render(layers=["depth"]).depth
        a, b = (9 + 0.5) / 16, 1 - (4 + 0.5) / 12
        self.assertAlmostEqual(scene.trace(*scene.camera.ray(a, b)).t, depth[4, 9], 5)
        self.assertEqual(glint.Camera().ray(0.5, 0.5)[1], (0, 0, -1))


class Recipes(TestCase):
    def test_of_an_image(self):
        image = ball().render(width=8, samples=4, crop=(1, 2, 3, 4))
        recipe = image.recipe
        self.assertEqual((recipe.size, recipe.crop), ((8, 12), (1, 2, 3, 4)))
        self.assertEqual((recipe.samples, recipe.light, recipe.dialect), (4, 0, "glint"))
        self.assertEqual([file.name for file in recipe.files], ["ball.xml"])
        self.assertIsNone(recipe.pixels_digest)
        self.assertIn("samples 4\n", str(recipe))
        self.assertIsNone(glint.Image([[[0, 0, 0]]]).recipe)

    def test_in_a_file(self):
        path = self.folder / "a.png"
        image = ball(keep_sources=True).render(embed=True)
        image.save(path)
        recipe = glint.Recipe.load(path)
        self.assertEqual(recipe.files[0].content, BALL.encode())
        self.assertEqual(recipe.pixels_digest, image.digest())
        self.assertEqual(glint.picture_digest(path), image.digest())
        glint.Image(image.pixels).save(path)
        with self.assertRaisesRegex(glint.GlintError, "no recipe"):
            glint.Recipe.load(path)
        with self.assertRaises(glint.GlintError):
            ball().render(embed=True)


class Files(TestCase):
    def test_png_holds_rgb8(self):
        image = ball().render()
        width, height, rows = png_rows(image.png())
        self.assertEqual((width, height), (16, 12))
        self.assertEqual(rows, flat(image.rgb8()))
        self.assertEqual(image._repr_png_(), image.png())
        self.assertIn(b"ball.xml", image.png())

    def test_files_are_those_of_memory(self):
        scene = ball()
        image = scene.render()
        for name in ("a.png", "a.pfm", "a.exr"):
            image.save(self.folder / name)
            scene.render_to(self.folder / ("b" + name))
            with self.subTest(name):
                found = (self.folder / name).read_bytes()
                self.assertEqual(found, (self.folder / ("b" + name)).read_bytes())
        self.assertEqual((self.folder / "a.png").read_bytes(), image.png())
        pfm = (self.folder / "a.pfm").read_bytes()
        self.assertEqual(struct.unpack("<3f", pfm[-12:]), tuple(flat(image.pixels)[45:48]))

    def test_files_are_those_of_the_program(self):
        program = os.environ.get("GLINT_PROGRAM")
        if program is None:
            self.skipTest("GLINT_PROGRAM names no program")
        path = SCENES / "solids.xml"
        options = ["-q", "--size", "90x50", "-o", self.folder / "a.png"]
        subprocess.run([program, *options, path], check=True)
        glint.Scene.from_file(path).render_to(self.folder / "b.png", width=90, height=50)
        self.assertEqual(
            (self.folder / "a.png").read_bytes(), (self.folder / "b.png").read_bytes()
        )

    def test_layers_in_exr(self):
        scene, layers = ball(), ["depth", "normal", "albedo", "surface"]
        scene.render(layers=layers).save(self.folder / "a.exr")
        scene.render_to(self.folder / "b.exr", layers=layers)
        data = (self.folder / "a.exr").read_bytes()
        self.assertEqual(data, (self.folder / "b.exr").read_bytes())
        for channel in (b"depth.Z", b"normal.X", b"albedo.R", b"surface.I"):
            self.assertIn(channel, data)
        scene.render(layers=layers).save(self.folder / "a.png")
        with self.assertRaisesRegex(ValueError, "room for layers"):
            scene.render_to(self.folder / "b.png", layers=layers)

    def test_names(self):
        glint.can_save("a.png")
        image = ball().render()
        for call in (glint.can_save, image.save, ball().render_to):
            with self.assertRaisesRegex(glint.GlintError, "png"):
                call(self.folder / "a.jpeg")
        with self.assertRaises(glint.GlintError) as caught:
            image.save(self.folder / "none" / "a.png")
        self.assertEqual(caught.exception.path, str(self.folder / "none" / "a.png"))
        self.assertEqual(os.listdir(self.folder), [])
