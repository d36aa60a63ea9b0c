# SPDX-License-Identifier: MIT
"""Builds the extension by CMake, from the tree that this folder stands in or, in a source distribution, from core/."""

import os
import pathlib
import re
import shutil
import subprocess
import sysconfig

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext
from setuptools.command.sdist import sdist

HERE = pathlib.Path(__file__).resolve().parent
CORE = HERE / "core" if (HERE / "core").exists() else HERE.parent.parent
NEEDED = ["CMakeLists.txt", "LICENSE", "cmake", "include", "soa", "kernels", "dispatch", "files", "fit"]


class BuildByCMake(build_ext):
    def build_extension(self, ext: Extension) -> None:
        out = pathlib.Path(self.get_ext_fullpath(ext.name)).resolve().parent
        build = pathlib.Path(self.build_temp).resolve()
        build.mkdir(parents=True, exist_ok=True)
        subprocess.run(["cmake", "-S", str(HERE), "-B", str(build), "-DCMAKE_BUILD_TYPE=Release", f"-DNARC_SOURCE={CORE}",
                        f"-DNARC_PYTHON_INCLUDE={sysconfig.get_path('include')}",
                        f"-DCMAKE_LIBRARY_OUTPUT_DIRECTORY={out}", *os.environ.get("CMAKE_ARGS", "").split()], check=True)
        subprocess.run(["cmake", "--build", str(build), "--target", "python_modules", "--parallel", str(os.cpu_count() or 1)],
                       check=True)


class WithCore(sdist):
    def make_release_tree(self, base_dir: str, files: list[str]) -> None:
        super().make_release_tree(base_dir, files)
        for name in NEEDED:
            copy = shutil.copytree if (CORE / name).is_dir() else shutil.copy
            pathlib.Path(base_dir, "core").mkdir(exist_ok=True)
            copy(CORE / name, pathlib.Path(base_dir, "core", name))
        for name in ("CMakeLists.txt", "src"):
            if (HERE / name).is_dir():
                shutil.copytree(HERE / name, pathlib.Path(base_dir, name), dirs_exist_ok=True)
            else:
                shutil.copy(HERE / name, base_dir)


# What is built goes to the tree's build folder, not among the sources.
options = {}
if CORE != HERE / "core":
    base = CORE / "build" / "wheel"
    base.mkdir(parents=True, exist_ok=True)
    options = {"build": {"build_base": str(base)}, "egg_info": {"egg_base": str(base)}}

version = re.findall(r"#define NARC_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)", (CORE / "include" / "narc.h").read_text())
setup(version=".".join(version), options=options, ext_modules=[Extension("narc._narc", [], py_limited_api=True)],
      cmdclass={"build_ext": BuildByCMake, "sdist": WithCore})
