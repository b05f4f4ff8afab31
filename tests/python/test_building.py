# SPDX-License-Identifier: MIT
"""Scenes built by calls are those of files."""

import struct
import zlib

import glint
from support import BALL, SCENES, TestCase, flat, needs_numpy


def prepared(width=16, height=12, **image):
    """A scene that lacks only surfaces."""
    scene = glint.Scene(threads=1)
    scene.set_image(width, height, **image)
    scene.set_camera(view_point=(0, 0, 4), view_width=1.6, view_height=1.2)
    scene.add_light("point", position=(4, 5, 6))
    scene.add_light("point", position=(-4, 5, 6))
    return scene


def same(a, b):
    return bytes(a.render().pixels) == bytes(b.render().pixels)


def png(path, pixels):
    """Writes rows of (r, g, b) as the simplest PNG there is."""

    def chunk(name, data):
        check = zlib.crc32(name + data)
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", check)

    size = struct.pack(">IIBBBBB", len(pixels[0]), len(pixels), 8, 2, 0, 0, 0)
    rows = b"".join(b"\0" + bytes(v for pixel in row for v in pixel) for row in pixels)
    parts = [chunk(b"IHDR", size), chunk(b"IDAT", zlib.compress(rows)), chunk(b"IEND", b"")]
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + b"".join(parts))


class Building(TestCase):
    def test_as_from_a_file(self):
        scene = prepared()
        self.assertEqual(scene.add_sphere(), 1)
        self.assertTrue(same(scene, glint.Scene.from_string(BALL)))

    def test_every_surface(self):
        scene = prepared()
        red = scene.add_shader("phong", diffuse_color=(1, 0, 0), exponent=20)
        self.assertIsInstance(red, glint.ShaderId)
        ids = [
            scene.add_sphere((0, 0, 0), 0.5, shader=red),
            scene.add_box((-1, -1, -1), (-0.5, 1, 0)),
            scene.add_cylinder((1, 0, 0), 0.2, 1.5),
            scene.add_cone((0, 1, 0), 0.3, 0.5, 1.0),
            scene.add_plane((0, -1, 0), (0, 1, 0)),
            scene.add_disc((0, 0, -2), (0, 0, 1), 3),
        ]
        group = scene.add_group([[1, 0, 0, 0.5], [0, 1, 0, 0], [0, 0, 1, 0]])
        self.assertIsInstance(group, glint.GroupId)
        ids.append(scene.add_sphere((0, 0, 1), 0.2, parent=group))
        scene.add_group([[1, 0, 0, -1], [0, 1, 0, 0], [0, 0, 1, 0]], source=group)
        self.assertEqual(ids, [1, 2, 3, 4, 5, 6, 7])
        self.assertEqual(scene.trace((0, 0, 4), (0, 0, -1)).surface, ids[0])
        self.assertEqual(scene.trace((0.5, 0, 4), (0, 0, -1)).surface, ids[6])
        self.assertEqual(scene.trace((-0.5, 0, 4), (0, 0, -1)).surface, ids[6])
        self.assertEqual(scene.info.surface_count, 8)

    def test_every_shader_and_light(self):
        scene = prepared(samples=4, integrator="path", max_depth=3, back_color=(0.1, 0.1, 0.2))
        base = scene.add_shader()
        for kind in glint.ShaderType:
            shader = scene.add_shader(kind, substrate=base if kind.name == "GLAZED" else None)
            scene.add_sphere((0, 0, -shader), shader=shader)
        for kind in glint.LightType:
            scene.add_light(kind.name.lower(), direction=(0, 1, 1), up=(1, 0, 0))
        self.assertEqual(scene.info.light_count, 2 + len(glint.LightType))
        self.assertTrue(all(value >= 0 for value in flat(scene.render().pixels)))

    def test_mesh(self):
        scene = prepared()
        mesh = scene.add_mesh([[-1, -1, 0], [1, -1, 0], [0, 1, 0]], [[0, 1, 2]])
        surface = scene.add_mesh_surface(mesh)
        self.assertEqual(scene.trace((0, 0, 4), (0, 0, -1)).surface, surface)
        self.assertIsNone(scene.trace((0.9, 0.9, 4), (0, 0, -1)))

    @needs_numpy
    def test_mesh_of_arrays(self):
        import numpy

        positions = numpy.array([[-1, -1, 0], [1, -1, 0], [0, 1, 0]])  # 64 bits, copied
        for corners in (numpy.array([[0, 1, 2]]), numpy.array([[0, 1, 2]], "uint32")):
            scene = prepared()
            mesh = scene.add_mesh(
                positions,
                corners,
                normals=numpy.ones((3, 3), "float32")[::1],
                texcoords=positions[:, :2],
            )
            scene.add_mesh_surface(mesh)
            self.assertIsNotNone(scene.trace((0, 0, 4), (0, 0, -1)))

    def test_texture(self):
        rows = [[(255, 0, 0), (0, 255, 0)], [(0, 0, 255), (255, 255, 255)]]
        png(self.folder / "colors.png", rows)
        pictures = []
        for load in (False, True):
            scene = prepared()
            if load:
                texture = scene.load_texture(self.folder / "colors.png", wrap="clamp")
            else:
                texture = scene.add_texture(rows, wrap="clamp")
            self.assertEqual(texture, 1)
            mesh = scene.add_mesh(
                [[-1, -1, 0], [1, -1, 0], [0, 1, 0]],
                [[0, 1, 2]],
                texcoords=[[0, 0], [1, 0], [0.5, 1]],
            )
            scene.add_mesh_surface(mesh, shader=scene.add_shader(texture=texture))
            pictures.append(bytes(scene.render().pixels))
        self.assertEqual(pictures[0], pictures[1])

    def test_files(self):
        scene = prepared()
        mesh = scene.load_mesh(SCENES / "data" / "board.obj")
        scene.add_mesh_surface(mesh)
        scene.load_environment(SCENES / "data" / "sky.pfm", 0.5)
        self.assertTrue(any(flat(scene.render().pixels)))
        with self.assertRaises(glint.GlintError) as caught:
            glint.Scene().load_mesh(self.folder / "none.obj")
        self.assertEqual(caught.exception.path, str(self.folder / "none.obj"))


class Refusals(TestCase):
    def refuses(self, kind, what, call, *arguments, **values):
        with self.assertRaisesRegex(kind, what):
            call(*arguments, **values)

    def test_names(self):
        scene = glint.Scene()
        self.refuses(ValueError, "did you mean 'phong'", scene.add_shader, "fong")
        self.refuses(ValueError, "did you mean 'point'", scene.add_light, "pint")
        self.refuses(TypeError, "LightType or its name", scene.add_light, 3)
        self.refuses(TypeError, "LightType", scene.add_light, glint.ShaderType.GLASS)

    def test_numbers(self):
        scene = glint.Scene()
        self.refuses(ValueError, "center needs 3 numbers; found 2", scene.add_sphere, (0, 0))
        self.refuses(ValueError, "center needs 3 numbers", scene.add_sphere, (0, 0, 0, 0))
        self.refuses(TypeError, "", scene.add_sphere, 3)
        self.refuses(glint.GlintError, "radius must be positive", scene.add_sphere, radius=-1)
        self.refuses(glint.GlintError, "center is not", scene.add_sphere, (0, 0, float("nan")))
        self.refuses(ValueError, "width is out of range", scene.set_image, 2**32 + 16, 16)
        self.refuses(TypeError, "", scene.set_image, 16.5, 16)
        self.refuses(glint.GlintError, "width", scene.set_image, 0, 16)
        self.refuses(ValueError, "transform needs 3 rows", scene.add_group, [[1, 0, 0, 0]])
        self.refuses(ValueError, "transform needs 4 numbers", scene.add_group, [[1, 0, 0]] * 3)
        self.refuses(glint.GlintError, "singular", scene.add_group, [[0, 0, 0, 0]] * 3)

    def test_meshes(self):
        mesh = glint.Scene().add_mesh
        three = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
        self.refuses(ValueError, "shape n x 3, not 3 x 2", mesh, [[0, 0]] * 3, [[0, 1, 2]])
        self.refuses((TypeError, ValueError), "", mesh, three, [[0, 1, -1]])
        self.refuses((TypeError, ValueError), "", mesh, three, [[0, 1, 2**32]])
        self.refuses(TypeError, "", mesh, three, [[0, 1, 1.5]])
        self.refuses(glint.GlintError, "", mesh, three, [[0, 1, 3]])
        self.refuses(glint.GlintError, "", mesh, three, [])
        one = {"normals": [[0, 0, 1]]}
        self.refuses(ValueError, "normals must have a row", mesh, three, [[0, 1, 2]], **one)
        self.refuses((TypeError, ValueError), "", mesh, [[0, 0, 0], [1, 0]], [[0, 1, 2]])
        self.refuses((TypeError, ValueError), "", mesh, [["a", 0, 0]] * 3, [[0, 1, 2]])

    def test_ids_of_elsewhere(self):
        scene = glint.Scene()
        self.refuses(glint.GlintError, "shader", scene.add_sphere, shader=glint.ShaderId(7))
        self.refuses(glint.GlintError, "parent", scene.add_sphere, parent=glint.GroupId(7))
        self.refuses(glint.GlintError, "mesh", scene.add_mesh_surface, glint.MeshId(1))

    def test_nothing_to_draw(self):
        self.refuses(glint.GlintError, "no image", glint.Scene().render)
