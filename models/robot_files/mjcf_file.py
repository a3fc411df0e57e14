"""Reads a robot from an MJCF file, by MuJoCo, which is an extra of this package.

file -> mjcf_check.py -> mujoco_process.py -> MuJoCo in another process -> arrays -> FileChain
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import CodedError, Message
from onpath.models.robot_files.chain import Joint, Shape
from onpath.models.robot_files.file_chain import (
    MOST_JOINTS,
    FileChain,
    Group,
    Options,
    RigidTransform,
    TipAt,
    aligned,
    check_joints,
    exact,
    guessed_tip,
    locked_guesses,
    some_names,
    tip_at,
    turn,
)
from onpath.models.robot_files.file_masses import (
    DENSITY,
    LinkMass,
    is_dummy,
    mass_factor,
    mass_guess,
)
from onpath.models.robot_files.guesses import Guess
from onpath.models.robot_files.mjcf_check import all_elements, checked_model
from onpath.models.robot_files.mujoco_process import read_model
from onpath.models.robot_files.tip_guess import TipPlace, suggested_tips, surplus_joints
from onpath.models.robot_files.whole_chain import whole_chain
from onpath.models.robot_files.xml_elements import Element, FileFault, safe_name, shown

FREE, BALL, SLIDE = 0, 1, 2  # types of joints in MuJoCo; 3 turns
SPHERE, CAPSULE, ELLIPSOID, CYLINDER, BOX, MESH = range(2, 8)  # types of geoms
HIDDEN = 3  # group of geoms, from which on MuJoCo's viewer shows none


def read_mjcf(file: Path, root: Element, options: Options) -> FileChain:
    """The chain of an MJCF file, from the world to the body or site that is the tip.

    A keyframe named "home", or the first one, is its pose at home. Springs, tendons and equality
    constraints are left out, and contacts, too.

    Args:
        root: its outermost element.

    Raises:
        FileFault: something in the file is refused.
        CodedError: MuJoCo is not installed or cannot read the file in time, or an option names a
            joint or tip that does not exist.
    """
    checked = checked_model(file, root, options.packages)
    model, warnings = read_model(checked.text, checked.meshes, file.name)
    read = _Model(model, root, options).read()
    told = [Message("robot_file.mujoco_warns", {"reason": each}) for each in warnings]
    if checked.lacking:
        told.append(Message("robot_file.not_drawn", some_names([*dict.fromkeys(checked.lacking)])))
    looks = hashlib.sha256(b"".join(checked.meshes.values())).hexdigest()[:16]
    rests = read.rests + (looks if checked.meshes else "")
    return replace(read, remarks=(*read.remarks, *told), rests=rests)


class _Model:
    """A model of MuJoCo.

    Args:
        root: of its file, for the places of faults.
    """

    def __init__(self, model: Any, root: Element, options: Options) -> None:
        for names in ("body_names", "joint_names", "site_names"):
            setattr(model, names, [safe_name(name) for name in getattr(model, names)])
        self._model, self._root, self._options = model, root, options
        self._way = set[int]()  # bodies from the world to the tip
        self._held = dict[str, str]()  # joints on the way that are locked without being asked
        model.joint_names = [name or f"joint{i}" for i, name in enumerate(model.joint_names)]
        self._joints = {name: i for i, name in enumerate(model.joint_names)}
        check_joints(options, self._joints)

    def read(self) -> FileChain:
        """The chain, its home and remarks."""
        model = self._model
        tips = self._suggested()
        tip, place = self._tip(tips[0])
        body = tip
        while body:
            self._way.add(body)
            body = int(model.body_parentid[body])
        self._held = self._held_joints(tips[0])
        groups, frames = [Group("world")], [(0, RigidTransform())]
        for body in range(1, len(model.body_names)):
            number, before = frames[int(model.body_parentid[body])]
            here = before @ _place(model.body_pos[body], model.body_quat[body])
            number, here = self._joined(body, body in self._way, number, here, groups)
            frames.append((number, here))
        weighed = self._weighed([body for body, (number, _) in enumerate(frames) if number])
        links = list[list[LinkMass]]([[] for _ in groups])
        geoms = [int(body) for body in model.geom_bodyid]
        for body, (number, here) in enumerate(frames):
            own = [i for i, each in enumerate(geoms) if each == body]
            drawn = [shape for i in own for shape in self._shapes(i, here)]
            groups[number].shapes += drawn
            links[number].append(self._link_mass(body, here, drawn, weighed.get(body, 1.0)))
        number, here = frames[tip]
        if number == 0:
            raise FileFault(self._root, Message("robot_file.still_tip"))
        chain, guesses, numbers = whole_chain(
            groups=groups, links=links, tip=here @ place, name=tips[0], options=self._options
        )
        return FileChain(
            chain=chain,
            home=self._home(),
            remarks=tuple(self._remarks()),
            guesses=(*self._guesses(tips[0]), *self._mass_guess(weighed), *guesses),
            tips=tips,
            places=dict(self._tip_places(tips, frames)),
            rests=numbers,
        )

    def _tip_places(
        self, tips: Sequence[str], frames: Sequence[tuple[int, RigidTransform]]
    ) -> Iterator[tuple[str, TipAt]]:
        """Where each suggested tip is."""
        for name in tips:
            body, place = self._tip(name)
            number, here = frames[body]
            yield name, tip_at(number, (here @ place).translation)

    def _link_mass(
        self, body: int, here: RigidTransform, drawn: Sequence[Shape], factor: float
    ) -> LinkMass:
        """The mass of a body times a factor, and what is drawn of it, in the frame of its group."""
        model = self._model
        name, mass = model.body_names[body], factor * float(model.body_mass[body])
        inertial = here @ _place(model.body_ipos[body], model.body_iquat[body])
        stated = model.impossible.get(body, np.diag(model.body_inertia[body]))
        inertia = inertial.rotation @ stated @ inertial.rotation.T
        if is_dummy(mass, inertia):
            return LinkMass(name, drawn=drawn)
        return LinkMass(
            name=name,
            mass=mass,
            centre=inertial.translation,
            inertia=factor * inertia,
            drawn=drawn,
        )

    def _weighed(self, moving: Sequence[int]) -> dict[int, float]:
        """What multiplies the masses that MuJoCo gives to bodies of which the file says none.

        Args:
            moving: numbers of the bodies that move.

        Raises:
            CodedError: see `mass_factor`.
        """
        masses = {body: float(self._model.body_mass[body]) for body in moving}
        weighed = [body for body in moving if body in self._model.weighed and masses[body]]
        if not weighed:
            return {}
        guessed = sum(masses[body] for body in weighed)
        factor = mass_factor(self._options, sum(masses.values()) - guessed, guessed)
        return dict.fromkeys(weighed, factor)

    def _mass_guess(self, weighed: Mapping[int, float]) -> Iterator[Guess]:
        """The guess of the masses of the bodies in `_weighed`."""
        model = self._model
        names = [model.body_names[body] or f"body{body}" for body in weighed]
        total = sum(factor * float(model.body_mass[body]) for body, factor in weighed.items())
        for factor in {*weighed.values()}:
            yield mass_guess(names, total, DENSITY * factor, "", self._options)

    def _joined(
        self, body: int, on_way: bool, number: int, here: RigidTransform, groups: list[Group]
    ) -> tuple[int, RigidTransform]:
        """The group of a body behind its joints, and its place in that."""
        model = self._model
        first, count = int(model.body_jntadr[body]), int(model.body_jntnum[body])
        for i in range(first, first + count):
            name, kind = model.joint_names[i], int(model.jnt_type[i])
            if not self._moves(i):
                continue
            anchor = RigidTransform(translation=np.array(model.jnt_pos[i]))
            back = RigidTransform(translation=-anchor.translation)
            axis = np.array(model.jnt_axis[i])
            if not on_way or name in self._options.lock or name in self._held:
                here = here @ anchor @ _moved(kind, axis, self._locked(i, name)) @ back
                continue
            frame = RigidTransform(aligned(axis))
            groups.append(
                Group(model.body_names[body], self._joint(i, name), here @ anchor @ frame)
            )
            number, here = len(groups) - 1, RigidTransform(frame.rotation.T) @ back
        return number, here

    def _element(self, joint: str) -> Element:
        """The element of a joint; that of the whole file if it has no name."""
        named = (each for each in all_elements(self._root) if each.tag in ("joint", "freejoint"))
        return next(
            (each for each in named if safe_name(each.values.get("name", "")) == joint), self._root
        )

    def _joint(self, i: int, name: str) -> Joint:
        model = self._model
        dof, reference = int(model.jnt_dofadr[i]), float(model.qpos0[model.jnt_qposadr[i]])
        low, high = -math.inf, math.inf
        if model.jnt_limited[i]:
            low, high = (float(end) - reference for end in model.jnt_range[i])
        written = [float(end) for end in model.jnt_range[i]]
        if written[0] > written[1]:  # MuJoCo takes them for no limits
            low, high = (f"{end:g}" for end in written)
            reason = Message("robot_file.limits", {"low": low, "high": high})
            raise FileFault(self._element(name), reason)
        damping = float(np.ravel(model.dof_damping[dof])[0])
        armature = float(model.dof_armature[dof])
        for field, value in {"damping": damping, "armature": armature}.items():
            if value < 0:
                raise FileFault(
                    self._element(name), Message("robot_file.negative", {"field": field})
                )
        return Joint(
            name=name,
            slides=int(model.jnt_type[i]) == SLIDE,
            low=low,
            high=high,
            effort=self._effort(i),
            damping=damping,
            armature=armature + self._options.armature,
        )

    def _effort(self, i: int) -> float:
        """The largest torque of the actuators of a joint; infinite if they have no limit."""
        model = self._model
        if model.jnt_actfrclimited[i]:
            return float(np.abs(model.jnt_actfrcrange[i]).max())
        efforts = [
            float(np.abs(model.actuator_forcerange[a] * model.actuator_gear[a][0]).max())
            for a in range(len(model.actuator_gear))
            if model.actuator_trnid[a][0] == i and model.actuator_forcelimited[a]
        ]
        return sum(efforts) or math.inf

    def _locked(self, i: int, name: str) -> float:
        """How far a locked joint is from its reference."""
        options, at = self._options, int(self._model.jnt_qposadr[i])
        reference = float(self._model.qpos0[at])
        return options.lock.get(name, options.pose.get(name, reference)) - reference

    def _shapes(self, geom: int, body: RigidTransform) -> Iterator[Shape]:
        """What is drawn of a geom: nothing of planes, height fields and what is invisible."""
        model, kind = self._model, int(self._model.geom_type[geom])
        if model.geom_group[geom] >= HIDDEN or not model.geom_rgba[geom][3]:
            return
        a, b, c = (float(x) for x in model.geom_size[geom])
        sizes = {
            SPHERE: ("sphere", (a, a, a)),
            ELLIPSOID: ("sphere", (a, b, c)),
            CAPSULE: ("capsule", (a, a, 2 * b)),
            CYLINDER: ("cylinder", (a, a, 2 * b)),
            BOX: ("box", (2 * a, 2 * b, 2 * c)),
            MESH: ("mesh", (1.0, 1.0, 1.0)),
        }
        if kind not in sizes:
            return
        name, size = sizes[kind]
        here = body @ _place(model.geom_pos[geom], model.geom_quat[geom])
        yield Shape(
            kind=name,
            file="",
            size=size,
            rotation=here.rotation,
            translation=here.translation,
            triangles=self._triangles(int(model.geom_dataid[geom])) if kind == MESH else None,
        )

    def _triangles(self, mesh: int) -> tuple[Array, np.ndarray]:
        """Vertices and triangles of a mesh, in the frame that MuJoCo has given it."""
        model = self._model
        first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
        face, faces = int(model.mesh_faceadr[mesh]), int(model.mesh_facenum[mesh])
        vertices = np.array(model.mesh_vert[first : first + count], dtype=float)
        return vertices, np.array(model.mesh_face[face : face + faces])

    def _home(self) -> dict[str, float]:
        """Coordinates of the joints in the keyframe."""
        model = self._model
        names = model.key_names
        if not names:
            return {}
        values = model.key_qpos[names.index("home") if "home" in names else 0]
        at = {n: int(model.jnt_qposadr[i]) for n, i in self._joints.items() if self._moves(i)}
        return {name: float(values[k] - model.qpos0[k]) for name, k in at.items()}

    def _suggested(self) -> tuple[str, ...]:
        """The bodies and sites that may be the tip; the first one is it."""
        tips = suggested_tips(self._places(), self._options.tip)
        if not tips:  # what moves has no name
            raise FileFault(self._root, Message("robot_file.still_tip"))
        return tips

    def _places(self) -> list[TipPlace]:
        """The bodies, parents before children, and then the sites."""
        model, places = self._model, [TipPlace("world", -1)]
        for body in range(1, len(model.body_names)):
            first, count = int(model.body_jntadr[body]), int(model.body_jntnum[body])
            joints = range(first, first + count)
            names = [model.joint_names[i] for i in joints if self._moves(i)]
            step = float(np.linalg.norm(model.body_pos[body]))
            parent = int(model.body_parentid[body])
            place = TipPlace(model.body_names[body], parent, tuple(names), step=step)
            places.append(place)
        for name, body, position in zip(
            model.site_names, model.site_bodyid, model.site_pos, strict=True
        ):
            places.append(TipPlace(name, int(body), step=float(np.linalg.norm(position))))
        return places

    def _moves(self, i: int) -> bool:
        """Whether a joint turns about an axis or slides along it."""
        return int(self._model.jnt_type[i]) not in (FREE, BALL)

    def _held_joints(self, tip: str) -> dict[str, str]:
        """The joints on the way to the tip that are locked without being asked, and why."""
        held, moving = dict[str, str](), list[str]()
        for name, i in self._joints.items():
            if int(self._model.jnt_bodyid[i]) not in self._way or name in self._options.lock:
                continue
            if not self._moves(i):
                held[name] = "robot_file.guessed_free"
            else:
                moving.append(name)
        many = surplus_joints(self._places(), tip, moving, MOST_JOINTS)
        return held | dict.fromkeys(many, "robot_file.guessed_many")

    def _guesses(self, tip: str) -> Iterator[Guess]:
        """What the file does not say."""
        options = self._options
        parents = {int(parent) for parent in self._model.body_parentid[1:]}
        bodies = [name for i, name in enumerate(self._model.body_names) if i and i not in parents]
        if not options.tip and len([name for name in self._model.site_names if name] or bodies) > 1:
            yield guessed_tip(tip)
        bodies_of = self._model.jnt_bodyid
        off = [name for name, i in self._joints.items() if int(bodies_of[i]) not in self._way]
        yield from locked_guesses(self._held, off, options)

    def _tip(self, wanted: str) -> tuple[int, RigidTransform]:
        """The body of the tip, and the tip in it."""
        model = self._model
        sites = {name: i for i, name in enumerate(model.site_names) if name}
        bodies = {name: i for i, name in enumerate(model.body_names) if i and name}
        if wanted in sites:
            i = sites[wanted]
            return int(model.site_bodyid[i]), _place(model.site_pos[i], model.site_quat[i])
        if wanted not in bodies:
            names = ", ".join([*sites, *bodies])
            raise CodedError("robot_file.no_tip", tip=shown(wanted), names=names)
        return bodies[wanted], RigidTransform()

    def _remarks(self) -> Iterator[Message]:
        left = [f"<{tag}>" for tag in ("equality", "tendon") if self._has(tag)]
        left += ["stiffness"] if np.any(self._model.jnt_stiffness) else []
        if left:
            yield Message("robot_file.left_out", {"parts": ", ".join(left)})

    def _has(self, tag: str) -> bool:
        """Whether the file has elements in another one of this name."""
        return any(part.children for part in self._root.all(tag))


def _place(position: Any, quaternion: Any) -> RigidTransform:
    """A frame from a position and a unit quaternion, its scalar first."""
    w, x, y, z = (float(part) for part in quaternion)
    vector = np.array([x, y, z])
    sine = float(np.linalg.norm(vector))
    if sine == 0:
        return RigidTransform(translation=np.array(position))
    return RigidTransform(exact(turn(vector / sine, 2 * math.atan2(sine, w))), np.array(position))


def _moved(kind: int, axis: Array, value: float) -> RigidTransform:
    return (
        RigidTransform(translation=value * axis)
        if kind == SLIDE
        else RigidTransform(turn(axis, value))
    )
