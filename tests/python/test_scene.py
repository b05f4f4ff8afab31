# SPDX-License-Identifier: MIT
"""Scenes from XML: what is in them, what is wrong with them, and their life."""

import gc
import io
import subprocess
import sys
import threading
import unittest
import weakref

import glint
from support import BALL, SCENES, SOURCE, TestCase

WRONG = BALL.replace("Sphere", "Sfere").replace(">4 5 6<", ">4 5<")


class Loading(TestCase):
    def test_file(self):
        with glint.Scene.from_file(SCENES / "solids.xml", threads=1) as scene:
            self.assertEqual((scene.info.width, scene.info.height), (720, 405))
            self.assertEqual(scene.info.surface_count, 6)
            self.assertEqual(scene.info.dialect, "glint")
            self.assertEqual(scene.name, str(SCENES / "solids.xml"))
            self.assertIn("720 x 405", repr(scene))
            self.assertGreater(scene.stats.read_bytes, 1000)
        self.assertTrue(scene.closed)
        self.assertIn("closed", repr(scene))

    def test_string_bytes_and_stream_are_the_same(self):
        scenes = [
            glint.Scene.from_string(BALL),
            glint.Scene.from_string(BALL.encode()),
            glint.Scene.from_stream(io.BytesIO(BALL.encode())),
        ]
        pictures = {bytes(scene.render().png().replace(b"stream", b"string")) for scene in scenes}
        self.assertEqual(len({bytes(scene.render().rgb8()) for scene in scenes}), 1, pictures)

    def test_files_of_a_string_are_found_by_its_name(self):
        xml = (SCENES / "globe.xml").read_text()
        with self.assertRaises(glint.GlintError):
            glint.Scene.from_string(xml, name=self.folder / "globe.xml")
        glint.Scene.from_string(xml, name=SCENES / "globe.xml")

    def test_the_dialect_can_be_named(self):
        scene = glint.Scene.from_string(BALL.replace(' dialect="glint"', ""), dialect="2012")
        self.assertEqual(scene.info.dialect, "2012")
        self.assertIn("2018b", glint.dialects())

    def test_bad_arguments(self):
        with self.assertRaisesRegex(ValueError, "unknown dialect '212': did you mean '2012'"):
            glint.Scene(dialect="212")
        with self.assertRaisesRegex(glint.GlintError, "abacus"):
            glint.Scene(isa="abacus")
        with self.assertRaises(glint.GlintError):
            glint.Scene(threads=-1)
        with self.assertRaisesRegex(ValueError, "zero byte"):
            glint.Scene.from_file("a\0b")
        with self.assertRaises(TypeError):
            glint.Scene(threads="2")

    def test_every_instruction_set_draws_the_same(self):
        pictures = [glint.Scene.from_string(BALL, isa=isa) for isa in glint.instruction_sets()]
        self.assertEqual(len({bytes(scene.render().pixels) for scene in pictures}), 1)


class Mistakes(TestCase):
    def test_all_are_told(self):
        with self.assertRaises(glint.GlintError) as caught:
            glint.Scene.from_string(WRONG, name="wrong.xml")
        error = caught.exception
        self.assertEqual(error.status, glint.Status.ERROR_SCENE)
        self.assertEqual((error.path, error.line, error.column), ("wrong.xml", 7, 18))
        self.assertEqual(error.message, 'unknown surface type "Sfere": did you mean "Sphere"?')
        self.assertEqual([d.line for d in error.diagnostics], [7, 8])
        self.assertEqual(
            str(error),
            'wrong.xml:7:18: error: unknown surface type "Sfere": did you mean "Sphere"?\n'
            '  <surface type="Sfere"/>\n'
            "                 ^~~~~\n"
            "wrong.xml:8:20: error: position needs 3 numbers; found 2\n"
            "  <light><position>4 5</position></light>\n"
            "                   ^~~",
        )

    def test_a_diagnostic_has_its_parts(self):
        with self.assertRaises(glint.GlintError) as caught:
            glint.Scene.from_string(WRONG)
        found = caught.exception.diagnostics[0]
        self.assertEqual(found.severity, glint.Severity.ERROR)
        self.assertEqual(found.excerpt[found.caret :][: found.caret_length], "Sfere")

    def test_no_file(self):
        with self.assertRaises(glint.GlintError) as caught:
            glint.Scene.from_file(self.folder / "none.xml")
        self.assertEqual(caught.exception.status, glint.Status.ERROR_FILE)
        self.assertEqual(caught.exception.path, str(self.folder / "none.xml"))
        self.assertIn("none.xml: ", str(caught.exception))

    def test_malformed_scenes(self):
        for expected in (SOURCE / "tests" / "malformed").glob("*.expected"):
            with self.subTest(expected.name), self.assertRaises(glint.GlintError) as caught:
                glint.Scene.from_file(expected.with_suffix(".xml"))
            self.assertTrue(str(caught.exception))

    def test_a_stream_that_fails(self):
        class Broken(io.RawIOBase):
            def read(self, size=-1):
                raise OSError("the cable is unplugged")

        with self.assertRaisesRegex(OSError, "unplugged"):
            glint.Scene.from_stream(Broken())

    def test_a_broken_scene_only_fails(self):
        scene = glint.Scene()
        with self.assertRaises(glint.GlintError):
            scene._load("glint_scene_load_file", self.folder / "none.xml", progress=None)
        with self.assertRaises(glint.GlintError):
            scene.render()


class Origins(TestCase):
    def test_files(self):
        files = glint.Scene.from_file(SCENES / "globe.xml").files
        self.assertEqual(files[0].kind, glint.FileKind.SCENE)
        self.assertEqual(files[0].path, str(SCENES / "globe.xml"))
        picture = next(file for file in files if file.kind == glint.FileKind.TEXTURE)
        self.assertEqual(picture.size, (SCENES / "data" / "globe.png").stat().st_size)
        self.assertEqual(glint.Scene().files, [])

    def test_sources(self):
        scene = glint.Scene.from_string(BALL, name="ball.xml", keep_sources=True)
        hit = scene.trace((0, 0, 5), (0, 0, -1))
        source = scene.source("surface", hit.surface)
        self.assertEqual((source.path, source.line, source.column), ("ball.xml", 7, 3))
        self.assertEqual(scene.source("light", 2).line, 9)
        self.assertIsNone(scene.source("light", 3))
        self.assertIsNone(scene.source("light", 0))
        self.assertIsNone(glint.Scene.from_string(BALL).source("light", 1))
        with self.assertRaisesRegex(ValueError, "did you mean 'surface'"):
            scene.source("surfce", 1)


    def test_checks(self):
        inside = BALL.replace("<position>4 5 6<", "<position>0.1 0 0<")
        scene = glint.Scene.from_string(inside, keep_sources=True)
        self.assertEqual(scene.diagnostics, ())
        (found, *_) = scene.check()
        self.assertEqual((found.severity, found.line), (glint.Severity.WARNING, 8))
        self.assertEqual(found.rule, "light-inside-solid")
        self.assertIn("light-inside-solid", str(found))
        self.assertEqual(glint.Scene.from_string(BALL).check(), ())


class Life(TestCase):
    def test_closed_scenes_refuse(self):
        scene = glint.Scene.from_string(BALL)
        scene.close()
        scene.close()
        for call in (scene.render, lambda: scene.info, lambda: scene.add_sphere()):
            with self.assertRaisesRegex(ValueError, "closed"):
                call()

    def test_the_last_reference_frees(self):
        scene = glint.Scene.from_string(BALL)
        native = weakref.ref(scene._native)
        image = scene.render()
        del scene
        gc.collect()
        self.assertIsNone(native())
        self.assertEqual(image.width, 16)

    def test_closed_while_drawing(self):
        scene = glint.Scene.from_string(BALL)
        scene.commit()
        image = scene.render(progress=lambda phase, share: scene.close())
        self.assertEqual(image.width, 16)
        self.assertTrue(scene.closed)

    def test_committed_scenes_do_not_change(self):
        scene = glint.Scene.from_string(BALL)
        scene.commit()
        scene.commit()
        with self.assertRaisesRegex(glint.GlintError, "committed"):
            scene.add_sphere()


class Calls(TestCase):
    def test_progress(self):
        seen = []
        scene = glint.Scene.from_file(
            SCENES / "solids.xml", threads=1, progress=lambda *p: seen.append(p)
        )
        scene.render(progress=lambda *p: seen.append(p))
        self.assertIn(glint.Phase.TRACE, {phase for phase, _ in seen})
        self.assertTrue(all(share <= 1 for _, share in seen))

    def test_an_exception_in_progress_cancels(self):
        class Enough(Exception):
            pass

        def progress(phase, share):
            raise Enough

        scene = glint.Scene.from_file(SCENES / "solids.xml")
        scene.commit()
        with self.assertRaises(Enough):
            scene.render(samples=65536, progress=progress)
        self.assertEqual(scene.render(width=4, height=3).width, 4)

    def test_no_call_within_a_call(self):
        scene = glint.Scene.from_string(BALL)
        with self.assertRaisesRegex(RuntimeError, "busy"):
            scene.render(progress=lambda *_: scene.render())

    def test_rays_within_a_call(self):
        scene, seen = glint.Scene.from_string(BALL), []
        scene.commit()
        scene.render(progress=lambda *_: seen.append(scene.trace((0, 0, 5), (0, 0, -1)).t))
        self.assertEqual(set(seen), {4.0})

    def test_threads_share_a_scene(self):
        scene, found = glint.Scene.from_string(BALL), []
        threads = [
            threading.Thread(target=lambda: found.append(bytes(scene.render().pixels)))
            for _ in range(8)
        ]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual((len(found), len(set(found))), (8, 1))

    def test_ctrl_c_stops_a_picture(self):
        code = (
            "import glint, os, signal, sys, threading, time\n"
            "signal.signal(signal.SIGINT, signal.default_int_handler)  # also in the background\n"
            "scene = glint.Scene.from_file(sys.argv[1])\n"
            "def stop():\n"
            "    time.sleep(0.3)\n"
            "    os.kill(os.getpid(), signal.SIGINT)\n"
            "threading.Thread(target=stop).start()\n"
            "try:\n"
            "    scene.render(width=8000, height=8000, samples=4096)\n"
            "except KeyboardInterrupt:\n"
            "    print('stopped', signal.getsignal(signal.SIGINT) is signal.default_int_handler)\n"
        )
        command = [sys.executable, *["-S"] * sys.flags.no_site, "-c", code]
        ended = subprocess.run(
            [*command, SCENES / "solids.xml"], capture_output=True, text=True, timeout=120
        )
        self.assertEqual(ended.stdout.split(), ["stopped", "True"], ended.stderr)


if __name__ == "__main__":
    unittest.main()
