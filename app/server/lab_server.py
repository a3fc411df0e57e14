"""Composition root: the server, the simulation thread, and a lab for every browser tab."""

from __future__ import annotations

import logging
import signal
import time
import webbrowser
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from functools import partial
from pathlib import Path

import viser

from onpath.app.classroom.classroom import Classroom
from onpath.app.common.access_codes import normalised
from onpath.app.common.end_signals import END_SIGNALS
from onpath.app.common.error_log import log_error
from onpath.app.common.periodic import Periodic
from onpath.app.exports import exporter as exports
from onpath.app.exports import upload_reader
from onpath.app.lab.lab import Lab
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.scene.build_queue import BuildQueue, one_at_a_time
from onpath.app.scene.client_scene import ClientScene
from onpath.app.scene.stage import set_initial_camera
from onpath.app.scene.stage_catalogue import stage_of
from onpath.app.server.admission_queue import AdmissionQueue
from onpath.app.server.built_in_course import built_in_course
from onpath.app.server.class_directory import ClassDirectory
from onpath.app.server.class_service import ClassService
from onpath.app.server.followed_lab import Followed
from onpath.app.server.heap import limit_heap
from onpath.app.server.lab_feed import LabFeed
from onpath.app.server.lab_registry import LabRegistry, RegisteredLab
from onpath.app.server.new_lab import new_lab
from onpath.app.server.own_part import own_part, screen_page
from onpath.app.server.page_context import PageContext
from onpath.app.server.page_data import PageData
from onpath.app.server.page_text import PageText
from onpath.app.server.plant_desk import PlantDesk
from onpath.app.server.robot_shapes import prepare_shapes
from onpath.app.server.robot_tips import Remark, RobotTips, TipPressed
from onpath.app.server.server_options import USUAL, ServerOptions
from onpath.app.server.site_address import reachable_site, site_for_students
from onpath.app.server.visit import Visit
from onpath.app.server.visits import Visits
from onpath.app.server.warm_up import compile_loops, warm_up
from onpath.app.server.watchdog import Watchdog, signs_of_life
from onpath.app.simulation.metrics import metrics_json
from onpath.app.simulation.simulation_thread import SimulationThread
from onpath.app.storage.expiry import Expiry
from onpath.app.storage.lease_keeper import LeaseKeeper
from onpath.app.storage.records import NotKept, Records
from onpath.app.storage.write_behind import WriteBehind
from onpath.app.viser_adapter.addresses import WALL, class_address
from onpath.app.viser_adapter.connections import turn_away
from onpath.app.viser_adapter.scene_release import clear_scene
from onpath.app.viser_adapter.secure_server import make_server
from onpath.lessons.course import NO_LESSONS, read_course
from onpath.lessons.problems import LessonError

log = logging.getLogger(__name__)
CHECK = 0.5  # [s] between checks for a signal
FREEING = 10.0  # [s] between searches for labs that were left


class LabServer:
    """A running lab server.

    Args:
        host, port: where to listen; port 0 takes a free one.
        loop_cache: compiles and keeps the loops.

    Raises:
        OSError: the address is not available; the message says why and what to do.
    """

    def __init__(
        self,
        host: str,
        port: int,
        loop_cache: LoopCache,
        options: ServerOptions = USUAL,
    ) -> None:
        self._host, self._loop_cache, self._options = host, loop_cache, options
        self._room = AdmissionQueue(options.most_clients)
        self._course = options.course or built_in_course()
        self.thread = SimulationThread()
        self._watchdog, self._leases = Watchdog(options.hang_seconds), None  # see `_start`
        self.visits = Visits(
            self._came,
            self._furnish,
            leave=lambda it: self.registry.leave(it),
            takes=lambda prefix, screen: not screen or self._classes.at(prefix) is not None,
        )
        make_server(
            host,
            port,
            label="OnPath",
            channel=self.visits.channel,
            prepare=self._prepare,
            scripts=own_part(),
            health=partial(metrics_json, self.thread),
            trouble=lambda: self._watchdog.trouble,
            elsewhere=self._is_elsewhere,
            screen=screen_page,
            limits=options.limits,
            allowed_origins=options.allowed_origins,
            trusted_proxies=options.trusted_proxies,
            unix_socket=options.unix_socket,
            course_url=options.course_url,
        )

    def _prepare(self, server: viser.ViserServer) -> None:
        """Make everything that the first page needs."""
        self.server, options = server, self._options
        robot, records = options.robot, options.records
        self.registry = LabRegistry(self.thread, self._page_lab)
        self.desk = None
        if options.plant is not None:
            self.desk = PlantDesk(self._new_lab(), options.plant)
            self.thread.add(self.desk.scheduled)
        self._memory = Periodic("memory", FREEING, self.registry.free_memory)
        self._keeper = self._expiry = None
        if records is not None:
            self._store_labs(records)
        self._classes = ClassDirectory(options.classrooms, self._class_service)
        self._newcomers = BuildQueue()
        self._tips = RobotTips(self.thread)
        set_initial_camera(server, stage_of(robot.make(robot.parameters())))
        self.visits.attend(server)
        self._start()

    def _new_lab(self) -> Lab:
        options = self._options
        return new_lab(
            self._loop_cache,
            self._course,
            options.robot,
            path=options.path,
            law=options.law,
            settings=options.settings,
            log=options.log,
        )

    def _page_lab(self) -> Lab:
        """The lab of a page; it rests if all pages show that of a plant."""
        lab = self._new_lab()
        lab.frozen = self._options.plant is not None
        return lab

    def _store_labs(self, records: Records) -> None:
        self._keeper = WriteBehind(records, lost=self._lost)
        self._expiry = Expiry(records, self._options.retention, self.registry.held)
        registry = self.registry
        registry.load, registry.is_current = records.claim, records.is_current
        registry.keeper, registry.give_up = self._keeper, records.give_up

    def _start(self) -> None:
        self.thread.start()
        self._memory.start()
        if self._expiry is not None:
            self._expiry.start()
        if self._options.records is not None:
            stored = self._classes.all_stored()
            self._leases = LeaseKeeper(self._options.records, self._open_here, stored, self._lost)
            self._leases.check()
            self._leases.rounds.start()
        self._watchdog.start(signs_of_life(self.thread, self.server.get_event_loop()))

    @property
    def address(self) -> str:
        """URL to open in a browser; the file of a Unix socket, which only a proxy can open."""
        if self._options.unix_socket is not None:
            return str(self._options.unix_socket)
        host = self._host
        shown = {"127.0.0.1": "localhost", "0.0.0.0": "localhost", "::": "::1"}.get(host, host)
        shown = f"[{shown}]" if ":" in shown else shown
        return f"http://{shown}:{self.server.get_port()}"

    @property
    def site(self) -> str:
        """The address at which other devices open the lab, as far as the server knows."""
        if self._options.allowed_origins:
            return self._options.allowed_origins[0]
        if self._options.unix_socket is not None:
            return ""
        return reachable_site(self._host, self.server.get_port())

    def stop(self) -> None:
        """Stop the server and all its threads."""
        if self.desk is not None:
            self.desk.plant.stop()
        self._watchdog.stop()
        self._memory.stop()
        self._newcomers.stop()
        self.thread.stop()
        if self.desk is not None:
            self.desk.plant.close()
        self.registry.check()
        self._loop_cache.close()
        for visit in self.visits:
            visit.show_nothing()
        exports.process.stop()
        upload_reader.process.stop()
        self.server.stop()
        if self._expiry is not None:
            self._expiry.stop()
        if self._keeper is not None:
            self._keeper.close()
        self._classes.stop()
        if self._leases is not None:
            self._leases.stop()
        if self._options.records is not None:
            self._options.records.close()

    def _class_service(self, classroom: Classroom, prefix: str) -> ClassService:
        records = self._options.records
        if records is not None and not records.warning:
            classroom.most_days = self._options.retention.class_days
        return ClassService(
            classroom,
            registry=self.registry,
            course=self._course,
            records=self._options.records,
            keeper=self._keeper,
            visits=partial(self.visits.under, prefix),
            lost=self._send_away,
            send=self.visits.channel.send,
        )

    def _is_elsewhere(self, prefix: str) -> bool:
        """Whether another process has the class under a prefix open."""
        if self._leases is None:
            return False
        return self._leases.is_elsewhere(self._classes.stored_as(prefix))

    def _open_here(self) -> list[str]:
        """The names in the database of all labs and classes that are open in this process."""
        return [*self.registry.held(), *self._classes.in_use()]

    def _came(self, visit: Visit) -> None:
        """Give a page its lab, once there is a place."""
        service = self._classes.at(visit.prefix)
        if service is not None and not service.greet(visit):
            self.visits.send_away({visit.number})
            return
        if service is not None and visit.screen:
            screens = service.wall if visit.screen == WALL else service.remotes
            screens.add(visit, site_for_students(visit.hello.site, self.site))
            return
        visit.at_end(partial(self._room.leave, visit.number))
        self._room.admit(
            visit.number,
            enter=partial(self._enter_lab, visit),
            wait=visit.wait,
            address=visit.address,
            always=visit.teacher is not None,
        )

    def _enter_lab(self, visit: Visit) -> None:
        if visit.has_ended:
            return
        try:
            self._open(visit, self.registry.join(visit.number, visit.hello.labs, visit.language))
        except Exception as error:
            log_error(error)
            self.visits.send_away({visit.number})

    def _open(self, visit: Visit, entry: RegisteredLab) -> None:
        """Show a page its lab, if both still exist."""
        visit.at_end(partial(self._give_back, visit.number, entry.code))
        if self.registry.find(entry.code) is not entry or entry.client != visit.number:
            return  # the page has left, or another process owns it now
        visit.show(entry.scheduled, self._feed(visit, entry))
        self._furnish(visit)

    def _furnish(self, visit: Visit) -> None:
        """Build the robots' picture of a page, once both its client and the lab are there."""
        self._newcomers.submit(partial(self._build, visit))

    def _build(self, visit: Visit) -> None:
        """Build the robots' picture of a page, unless it is there, or something is missing."""
        client, number, feed = visit.client, visit.asked, visit.feed
        if client is None or feed is None:
            return
        if feed.scene is not None and feed.scene.client is client:
            return
        try:
            scene = feed.make(client, self.thread.call(feed.first), number)
        except Exception as error:
            log_error(error)
            turn_away(self.server, client.client_id, "a picture that could not be built")
            return
        feed.furnish(scene)
        if visit.client is not client or visit.feed is not feed:
            feed.unfurnish(client)

    def _feed(self, visit: Visit, entry: RegisteredLab) -> LabFeed:
        """What shows a lab to a visit."""
        code, lab = entry.code, entry.scheduled.lab
        desk = self.desk
        drives = desk is not None and desk.sit(visit)
        if desk is not None:
            code, lab = "", desk.scheduled.lab if drives else lab
        service, teacher = self._classes.at(visit.prefix), visit.teacher
        reopen = partial(self._reopen, visit, entry)
        seat = (
            service.seat(visit, code, reopen, partial(self._enter, visit))
            if service
            else self._classes.seat_elsewhere(visit.prefix, code)
        )
        site = site_for_students(visit.hello.site, self.site)
        teaching = None
        followed: Followed | None = None if desk is None else desk.shown(drives)
        if service is not None and teacher is not None:
            teaching = service.teaching(visit, teacher, lab, reopen, site)
            followed = service.followed(teacher[1])
        records = self._options.records
        keeps = records is not None and not records.warning
        text = PageText(
            self._course,
            code,
            kept=visit.kept,
            keep=visit.keep,
            teaching=teaching,
        )
        context = PageContext(
            code=code,
            course=self._course,
            keep_days=self._options.retention.days if keeps else 0,
            enter=partial(self._enter, visit),
            text=text,
            choose_tip=partial(self._tips.choose, post=lab.post),
            remark=lambda text: lab.post(Remark(text)),
            seat=seat if teaching is None else None,
            look=visit.look,
            privacy_url=self._options.privacy_url,
            presses=visit.presses,
            teaching=teaching,
            drive=desk.hear if desk is not None and drives else None,
        )
        return LabFeed(
            PageData(visit.stream, lab, context, visit.sight),
            make=partial(
                ClientScene,
                look=visit.look,
                course=self._course,
                post=lab.post,
                choose_tip=lambda robot, tip: lab.post(
                    TipPressed(robot, tip, context.choose_tip, visit.presses)
                ),
                switches=context.switches,
            ),
            send=self.visits.channel.send,
            offset=visit.number,
            nickname=partial(service.nickname, code) if service else str,
            followed=followed,
        )

    def _enter(self, visit: Visit, text: str) -> None:
        """Move a page to the lab of a typed code.

        Raises:
            ValueError: invalid code, no such lab, or the lab is in use.
        """
        self._reopen(visit, self.registry.enter(visit.number, normalised(text)))

    def _give_back(self, number: int, code: str) -> None:
        self.registry.leave(number)
        self.registry.give_back(code)

    def _lost(self, code: str) -> None:
        """Send away the client of a lab that another process has."""
        with suppress(NotKept):
            if self._options.records is not None and self._options.records.is_current(code):
                return  # it has come back meanwhile
        number = self.registry.lose(code)
        if number is not None:
            self.visits.send_away({number})

    def _send_away(self, visits: set[int]) -> None:
        """Store all labs, and close the connections of pages, which reconnect at once."""
        if self._keeper is not None:
            for code in self.registry.held():
                if not self._keeper.flush(code):
                    break  # the others would wait as long, and in vain
        self.visits.send_away(visits)

    def _reopen(self, visit: Visit, entry: RegisteredLab) -> None:
        """Show a page another lab, or its own once more."""
        visit.sight.leave()
        self.thread.call(lambda: None)  # until the frame that still showed it has ended
        visit.show_nothing()
        client = visit.client
        if client is not None:
            with one_at_a_time:  # its scene may be under construction
                clear_scene(client)
        self._open(visit, entry)


def serve(
    host: str,
    port: int,
    lessons: Path | None = None,
    database: str | None = None,
    open_browser: bool = False,
    ready: Callable[[str], None] = lambda _: None,
    drives: Callable[[str], None] = lambda _: None,
    options: ServerOptions = USUAL,
) -> None:
    """Serve the lab until one of `END_SIGNALS`, such as Ctrl-C.

    Args:
        lessons: folder of the user's own lessons.
        database: URL of the database of labs; defaults to a file of the user's. If it is given, or
            if the server is behind a proxy, it must be usable; otherwise memory may replace it.
        ready: called when browsers may come, with the address at which other devices open the lab.
        drives: called then with the address of the page that drives a plant, if there is one.
        options: all others; `course` and `records` follow from the arguments above. Loops of a
            robot from a file are compiled first.

    Raises:
        LessonError: a lesson has errors.
        NotKept: the database cannot be used.
    """
    limit_heap()
    course, problems = read_course([lessons] if lessons else [], built_in_course())
    if problems:
        raise LessonError(problems)
    records = None
    if options.plant is not None:
        course = NO_LESSONS
    else:
        in_public = options.allowed_origins or options.trusted_proxies
        records = Records(database, needed=bool(database or in_public))
        if records.warning:
            log.warning("%s", records.warning)
    loop_cache = LoopCache()
    if options.robot.source is not None:
        compile_loops(loop_cache, options.robot)
        prepare_shapes(options.robot.source.chain)
    lab = LabServer(host, port, loop_cache, replace(options, course=course, records=records))
    try:
        for number in END_SIGNALS:
            signal.signal(number, _end)
        warm_up(loop_cache, course)
        log.info("OnPath is ready at %s  (Ctrl-C stops it)", lab.address)
        ready(lab.site)
        first = class_address(options.classrooms[0].code) if options.classrooms else ""
        if lab.desk is not None:
            first = f"/#drive={lab.desk.key}"
            drives(f"{lab.address}{first}")
        if open_browser:
            webbrowser.open(f"{lab.address}{first}")
        while True:  # a signal may go to another thread and then does not wake this one
            time.sleep(CHECK)
    except KeyboardInterrupt:
        log.info("stopping")
    finally:
        lab.stop()


def _end(*_: object) -> None:
    """End the server. Later signals are ignored while the last changes are stored."""
    for number in END_SIGNALS:
        signal.signal(number, signal.SIG_IGN)
    raise KeyboardInterrupt
