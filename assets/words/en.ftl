### What the interface says in English, for Project Fluent (https://projectfluent.org/).
###
### Every language has the same messages, with the same arguments. The code asks for "lesson.next"
### where this file has lesson-next. Only the names of parameters, paths, robots and control laws stand in
### models/ in English; other languages have them here, under parameter-, path-, machine- and law-.
### A count is a number, so that a language can choose the plural: { $count -> [one] … *[other] … }.

## Lessons

robot-follower = Follower
robot-tracker = Tracker
robot-under_law = { $robot } ({ $law })

quantity-distance = distance from the path
quantity-lag = distance to the running point
quantity-speed = speed along the path
quantity-rate = rate of the path's parameter
quantity-place = place along the path
quantity-across = offset across the path
quantity-across_rate = speed across the path
quantity-torque = torque
quantity-force = force
quantity-deflection = deflection
quantity-energy = energy in the link

stat-max = largest { $quantity }
stat-min = smallest { $quantity }
stat-mean = mean { $quantity }
stat-rms = rms { $quantity }
stat-settling = settling time of { $quantity }
stat-overshoot = overshoot of { $quantity }
stat-final = { $quantity } now

during-always = { "" }
during-held = { " " }while held
during-pulled = { " " }while pulled
during-free = { " " }while free
during-released = { " " }after letting go

check-below = below { $limit } { $unit }
check-above = above { $limit } { $unit }
check-and = { $first } and { $second }
check-broken = { " " }(missed at { $time } s)
check-bound = { $robot }: { $stat }{ $during } { $value } { $unit }; wanted: { $wanted }
check-compare = { $larger }'s { $stat }{ $during } is { $ratio } times the other's; wanted: { $wanted } times or more
check-better = { $robot }: { $stat }{ $during } { $value }; in the run before: { $before }; wanted: less
check-seconds = { " " }({ $have } of { $need } s)
check-nothing = { $robot }: { $stat }{ $during }: nothing yet{ $seconds }; wanted: { $wanted }
check-event = { $event }: { $have } of { $need }
check-since = { $event }, and none of this after it: { $events }
check-order = in this order: { $events }
check-setting = { $name } is { $value }; wanted: { $wanted }
check-equals = { $value }
check-path = path
check-length = length of the path in mm
check-robot = robot
check-start = start
check-wall = wall
check-own_path = your own
check-only = Changed besides what the task is about: { $others }. Set it back, or open the step again
check-once = { $robot }: while { $setting } is { $equals }, { $stat }{ $during } { $value } { $unit } for { $least } s; wanted: { $wanted }
check-stopped = { $robot } has stopped: press Reset and try again

event-hold = hold back
event-let_go = let go
event-pull = pull
event-release = release
event-set = change { $detail }
event-set_any = change a parameter
event-path = choose the path { $detail }
event-path_any = change the path
event-reset = reset
event-identify = identify
event-diverged = a robot stops
event-robot = choose the robot { $detail }
event-robot_any = choose another robot
event-law = choose the law { $detail }
event-law_any = choose another law

equations-title =
    { $count ->
        [one] Equation ({ $first }) of the paper, symbol by symbol
       *[other] Equations ({ $first }) to ({ $last }) of the paper, symbol by symbol
    }
equations-formula = paper
equations-here = here
equations-place = where
equations-lesson = lesson { $number }
equations-figure = figure { $number }
lesson-lessons = Lessons
lesson-choose = Lessons: predict, try, see, explain
lesson-minutes = { $minutes } min
lesson-optional = optional
lesson-warm_up = From an earlier lesson, and not counted
lesson-branch = for your answer
lesson-past_optional = Skip the optional steps, to step { $step }
lesson-past_all = Skip the optional steps and finish
lesson-aims = What it is for, and what you need
lesson-needs = You need:
lesson-goals = Afterwards you can:
lesson-close = Leave the lesson
lesson-close_hint = to the free lab; the lesson keeps your place
lesson-back = Back
lesson-wait = The class waits here until the teacher goes on.
lesson-out_of_pace = The teacher keeps the class within steps { $first } to { $last } for now.
lesson-next = Next
lesson-skip = Skip the prediction
lesson-finish = Finish
lesson-locked = First commit to a prediction, or skip it.
lesson-nothing_to_predict = there is nothing to predict here
lesson-no_such_option = there is no such answer
lesson-no_number = this is not a number
lesson-no_such_task = there is no such task in this step
lesson-no_more_hints = this task has no further hint
lesson-again = Restart step
lesson-again_hint = the robots and all settings as they were at the beginning of this step
lesson-play = Let it happen
lesson-skip_run = Skip the run
lesson-replay = Let it happen again
lesson-playing = It is happening: watch.
lesson-happened = The run is over. The text tells what happened.
lesson-step = Step { $step } of { $steps }
lesson-commit = Commit to this prediction
lesson-committed = You have committed to your prediction. Now see what happens.
lesson-drawn = Draw again, or commit.
lesson-yours = you
lesson-right = Right.
lesson-not_quite = Not quite.
sketch-looked_for = What to look for
sketch-own = in your curve
sketch-run = in the run
sketch-seen = yes
sketch-unseen = no
lesson-second_title = Second try
lesson-second_try = this question has been answered; the second try asks something else
lesson-once_more = Think it over and answer once more: then the right answer is shown.
lesson-discuss = Find somebody who answered differently and discuss it, then answer again.
lesson-discuss_curve = The chart keeps your first curve. Find somebody who drew another one and discuss it, then draw again.
lesson-discuss_letter = You answered { $letter }. Find somebody who answered differently and discuss it, then answer again.
lesson-second = After the discussion:
lesson-drawn_again = you drew the curve again
lesson-unknown = You answered this in an earlier version of the lesson. Its answers have changed since, so the lab cannot tell which one you chose.
lesson-skipped = You skipped the prediction.
lesson-predict_before = First go back and make the prediction, or skip it.
lesson-passed = Passed
lesson-passed_best = Passed; your best: { $best } { $unit }
lesson-hint = Hint ({ $left } left)
lesson-recipe = Last hint: the recipe (the task then counts as shown, not as solved)
lesson-controls = Controls
lesson-all_controls = All controls
lesson-language = Language
lesson-presenting = Presentation: large type
lesson-english = only in English

kind-play = Try freely
kind-predict = Predict
kind-run = See
kind-explain = Explain
kind-task = Do it
kind-quiz = Question

language-en = English

## Answers beside a prediction, and answers that are a number or a text

answer-how_sure = How sure are you? (optional)
answer-sure = You were:
answer-why = Your reason:
answer-because = Why? (optional)
answer-not_said = not said
answer-number = Your answer:
answer-words = You wrote:
answer-model = A model answer:
answer-type_number = Your number
answer-type_unit = Your number [{ $unit }]
answer-type_words = Your answer, in your own words
answer-type_formula = Your formula in { $names }
answer-check = Check
answer-price = Right at the first try counts in full, at the second half.
answer-before = And the answer to the previous question:
answer-price_followed = Right at once counts in full. After a wrong answer something else is asked, which counts half.
answer-price_second = A right answer counts half.
answer-keep = Keep my answer
answer-sending = Sending …
answer-sent = Sent.
answer-carried = Right, with your own value from before.
answer-line = The line reads:
formula-refused = Not understood from character { $place } on: { $reason }.
formula-missing = a number, a name or a bracket is missing
formula-between = before this number there is no sign such as + or *
formula-bracket = a bracket is missing, or is one too many
formula-exponent = an exponent is a whole number from 0 to { $most }; a root is sqrt(…)
formula-unclear = this can be read in two ways; brackets make it clear
formula-function = write { $name }(…), with brackets
formula-unknown = this means nothing here; there are { $names }
formula-long = at most { $most } characters
sure-guessing = guessing
sure-fairly = fairly sure
sure-certain = certain

## The end of a lesson

end-title = What you predicted, and what happened
end-route = The end of the route
end-right =
    { $all ->
        [one] { $part } of 1 choice right
       *[other] { $part } of { $all } choices right
    }
end-drawn =
    { $all ->
        [one] { $part } of 1 curve drawn
       *[other] { $part } of { $all } curves drawn
    }
end-tasks =
    { $all ->
        [one] { $part } of 1 task passed
       *[other] { $part } of { $all } tasks passed
    }
end-takeaway = What to take away
end-next = Open lesson { $lesson }
end-record = My record

## Keep and share

keep-title = Keep and share
keep-yours = Your lab's code. Note it down: with it you can continue elsewhere.
keep-until =
    { $days ->
        [one] Your lab is deleted when it has not been used for a day.
       *[other] Your lab is deleted when it has not been used for { $days } days.
    }
keep-other = Another code
keep-other_hint = The code of a lab that you began elsewhere
keep-go = Go to that lab
keep-share = Share this set-up
keep-shared = Send this address, or the code alone: both contain the robot, the path, the gains and the realism settings.
keep-paste = Share code
keep-paste_hint = Paste a code that somebody sent you
keep-use = Set up the lab from it
keep-report = Record of my lessons (HTML)
keep-failed = Your lab cannot be saved at the moment. You can go on: keep this page open until it says that the lab is saved again.
keep-too_large = Your lab has become too large to be saved. What was saved last is kept; what you do from now on is lost when you close this page.
keep-again = Your lab is saved again.
keep-anew = The file in which labs are saved was deleted or replaced. Your lab is being saved in a new one.
keep-with_code = Put my lab's code into the record
keep-with_code_means = Whoever has the code can open your lab, see what you did and change it. Leave it out of what you hand in.

## The class

full-text =
    { $places ->
        [one] The only place is taken.
       *[other] All { $places } places are taken.
    } Leave this page open: it continues by itself as soon as one is free.
full-network = All { $places } places for one network are taken; the rest is kept for other networks. Leave this page open: it continues by itself as soon as one is free.
full-before =
    { $count ->
        [0] Nobody has waited longer.
        [one] One page has waited longer.
       *[other] { $count } pages have waited longer.
    }

test-title_before = Before the course: { $title }
test-title_after = After the course: { $title }
test-open_name = Open the test: { $title }
test-hand_in = Hand in
test-handed_in = handed in
test-answered = { $part } of { $all } answered. You can change your answers until you hand in.
test-locked = The lab is paused during a test.
test-over = The test has been handed in.
test-thanks = Handed in. Thank you.
test-later = You will see what is right, and why, when you have handed in the test after the course.
test-score = { $part } of { $all } right
test-before = Before the course
test-after = After the course
test-chosen_before = Before:
test-chosen_after = After:
test-none = no answer
test-students = { $count ->
        [0] Nobody has handed in both tests yet.
        [one] 1 student has handed in both tests.
       *[other] { $count } students have handed in both tests.
    }
test-means = Right answers: { $before } before, { $after } after.
test-share = { $value } % ({ $low }–{ $high })
test-interval = { $value } ({ $low } to { $high })
test-fewest = What it has gained is shown from { $count } students on: with fewer, chance decides.
test-gain = Normalised gain: { $gain }
test-gain_means = The class has learned this share of what it did not know before: (after − before) / (100 % − before). Each half of the class has answered the other form first, and the means are those of both forms, so it does not matter if one form is easier.
test-gain_none = Normalised gain: not defined, since all answers were right before.
test-waiting = { $part } of { $all } have handed in the test before the course, { $after } the one after it.
test-number = No.
test-right_before = Right before
test-right_after = Right after
test-aims = What the wrong answers say
test-form = Form { $form }
test-alone = Concept test: each student answers alone.
test-treated = More about it: lesson { $lesson }, page { $step }.
test-of_form = Form { $form }: { $count } students
test-of_questions = The questions: { $count } students
test-difficulty = Right
test-discrimination = Discrimination
test-intervals = In brackets: the interval of 95 %, Wilson's for shares, a bootstrap of the students for the other numbers. Discrimination is the correlation of an answer with the number of right answers to the other questions, among those who answered the form before the course and among those who answered it after. Near 0 the question does not tell students apart; below 0 it misleads those who know more.
class-title = Class
class-code = Class code
class-code_hint = Shown on the projector
class-nickname = Nickname
class-nickname_hint = At most 24 characters; it need not be your real name
class-stored = Your lab stores your predictions and drawn curves, your answers, including those in your own words, your tasks and gains, and when you were last active. Your teacher sees all of it under your nickname. The nickname is deleted when you leave the class or it ends, the rest { $days ->
        [0] when the server stops
        [one] after a day without use
       *[other] after { $days } days without use
    }. Your teacher can delete it all at once.
class-kept_until = The class itself, with its nicknames, is deleted { $days ->
        [one] a day
       *[other] { $days } days
    } after its last change: if nobody uses it after today, on { $date }.
class-date = %Y-%m-%d
class-keep_for = Delete the class after its last change
class-days =
    { $days ->
        [one] after a day
       *[other] after { $days } days
    }
class-asks = Ask students for
class-asks_nothing = nothing that identifies them
class-asks_email = their e-mail address
class-asks_idnumber = their ID number
class-asks_username = their user name
class-grades = The record also has a sheet Grades, with points for taking part in each lesson: for what was answered, not for being right. Copy it into Moodle: Grades, Import, Paste from spreadsheet. Moodle takes all rows or none: it names the first entry that it does not know. Students find the field in the card under their nickname, which says “Sign the list” until they have.
class-id_email = E-mail address (your teacher sees this)
class-id_idnumber = ID number (your teacher sees this)
class-id_username = User name (your teacher sees this)
class-id_hint = For a list of who took part; you may leave it empty. It is deleted with your nickname.
class-id_known = Your teacher has this entry. Send another one to replace it, or an empty field to take it back.
class-id_send = Send
class-sign = Sign the list
class-word = A word of your own
class-word_hint = For studies, if you like: type the same word before and after the course, on any device, and your two tests are linked, also after months. The word shows nothing and deletes nothing. Only a hash of it is kept. At least 6 characters; do not use a password.
class-word_send = Link
class-word_own = Your word is kept. Send another one to replace it, or an empty field to remove it.
class-word_shared = Somebody else in this class has the same word, so your tests are mixed up. Choose another one.
class-forget_me = Delete everything that is stored of me
class-forget_me_sure = Delete your lab with your predictions, drawn curves, answers and tasks, and your place in the class? It cannot be undone. This page starts again with a new lab.
class-privacy = Privacy notice
class-join = Join the class
class-leave = Leave the class
class-elsewhere = Open the page of this class
class-member = You are in the class as { $name }. The teacher sees where you are in the lessons, and your lab.
class-teacher = Teacher…
class-key = Teacher's key
class-key_hint = The server says where it is when it starts
class-teach = Open the teacher's page
class-stop_teaching = Close the teacher's page
class-of = class { $code }
class-what_stored = What is stored of you?
class-then = When your teacher opens a step, it comes to this page by itself. Until then, the lab is yours.
class-gone = This lab is in no class now: the class has ended, your teacher has taken you out of it, or it is another lab than before. It goes on here without a class.
class-too_long = A nickname has at most { $most } characters.
class-frozen = The teacher has stopped all labs: look to the front. Yours continues from here afterwards.
class-setup = The teacher has set up your lab.
class-setup_in_step = The teacher has set up your lab. “Restart step” restores this step's own set-up.
class-step = The teacher has opened this step for you.
class-step_elsewhere = The teacher has opened this step for you. The lesson that you were in is under “Lessons”, as you left it.
class-step_again = The teacher asks this question again. Discuss it with your neighbour first.
class-ask_again = Ask this again, after a discussion
class-play = Play the demonstration here
class-put_back = Put my own set-up back
class-show_answers = Show the answers
class-lead = For the whole class
class-first = First answer
class-second = After the discussion
class-unknown = { $count } answered an earlier version of the question; their choices can no longer be known.
class-open_address = Open this address and type a nickname:
class-only_here = Only this computer can open it. To let others in, start with --host 0.0.0.0.
class-qr = QR code of this address
class-qr_remote = QR code of the teacher's address for a phone
class-wall = Open the wall for the projector, without controls or names
class-let_in = Let in the phone that shows { $number }
class-throw_out = Throw out phone { $number }
class-peek = Answers on this screen only
class-timer = Close in one minute
class-cell_here = here
class-cell_answered = answered
class-cell_right = right
class-cell_changed = changed
# $more: how many are in one of the states that follow.
class-dots_here =
    { $more ->
        [0] { $count } here
       *[other] { $count } not yet
    }
class-dots_answered =
    { $more ->
        [0] { $count } answered
       *[other] { $count } answered otherwise
    }
class-dots_right = { $count } right
class-dots_changed = { $count } changed
class-proposal_explain = { $percent } % are right: explain it?
class-proposal_discuss = { $percent } % are right: discuss, then ask again?
class-proposal_go_on = { $percent } % are right: go on?
class-remote = Teach from a phone: open this address on it
remote-title = Teacher
remote-ask = On the teacher's page, let in the phone that shows
remote-full = Too many phones are asking. Wait for two minutes.
remote-plain = This page is not encrypted: others in the same network could read along, and act as the teacher.
class-count = { $count } in the class
class-name = Nickname
class-lesson = Lesson
class-step_head = Step
class-tasks = Tasks
class-state = State
class-here = here
class-away = away
class-idle = idle for { $minutes } min
class-free = Free lab
class-nobody = Nobody has joined yet.
class-follow = Follow
class-own_lab = My own lab
class-rename_hint = At most 24 characters; the student sees it, too
class-remove = Remove from the class
class-removed = Removed. The lab goes on without the class, and can join again.
class-delete = Delete this student
class-delete_sure = Delete { $name } from the class, and the lab with everything that is stored of it: predictions, drawn curves, answers, tasks? It cannot be undone. An open page starts again with a new lab.
class-deleted = Deleted.
class-following = This is the lab of { $name }. You can only look.
class-hidden = This student's tab is hidden: the lab waits.
class-absent = This student is not connected: the lab waits.
class-freeze = Freeze all labs
class-unfreeze = Let all labs go on
class-push_setup = Send my set-up to all
class-push_code = Send this share code to all
class-push_step = Open this step for all
class-back = Back for all
class-next_step = Next for all: { $step }
class-sent =
    { $count ->
        [0] Nobody is here yet.
        [one] Sent to 1 student.
       *[other] Sent to { $count } students.
    } Students who join later will receive it.
class-standing_setup = Students who join receive the set-up that you sent last.
class-standing_step = Students who join are taken to the step that you opened last: { $lesson }, step { $step }.
class-push_end = Stop sending this to students who join
class-predictions = Predictions
class-truth = Show the truth
class-no_prediction = Nothing is asked in this step.
class-no_truth = What really happens is not known yet: it must first happen in a lab.
class-predicted = predictions
class-median = dashed: the median, with the middle half of the predictions around it
class-given =
    { $away ->
        [0] { $given } of { $here } here have answered.
       *[other] { $given } of { $here } here have answered ({ $away } away).
    }
class-moves = From the first answer (rows) to the second (columns)
class-other_shape = something else
class-drew = { $count } drew { $name } (such as { $example }).
class-drew_other = { $count } drew something else (such as { $example }).
class-skipped = { $count } skipped it.
class-late =
    { $count ->
        [one] 1 answer came after the vote was closed, and does not count.
       *[other] { $count } answers came after the vote was closed, and do not count.
    }
class-closes = The vote closes in { $seconds } s.
class-closed = The vote is closed.
class-came_late = The vote is closed: your answer is kept, but does not count.
class-close_vote = Close the vote
class-open_vote = Open the vote again
class-vote_is_open = The class is still voting. You can go on when your teacher closes the vote.
class-other_numbers = other numbers
class-is_it_you = { $name } is away. Is that you? Then your teacher can give you your place back, with everything that you did there.
class-ask_place = That is me: ask my teacher
class-place_asked = Your teacher has been asked whether you are { $name }.
class-claim = { $name } says: I am { $former }, and was away.
class-give_place = Yes, give the place back
class-keep_apart = No, that is somebody else
class-set_aside = Set aside all who are away ({ $count })
class-set_aside_told =
    { $count ->
        [one] 1 student is set aside until they come back.
       *[other] { $count } students are set aside until they come back.
    }
class-record = Record
class-record_text = One row for each answer, with its time and whether it was late, and for each task and each open question of the lessons begun. It contains nicknames: treat it as personal data.
class-export = Class record (XLSX)
class-end = End the class
class-end_sure = End the class? Nicknames and the class record are deleted; the labs continue without a class. Export the record first.
class-ended = The class is over. { $count ->
        [0] Nobody was in it.
        [one] 1 student was in it.
       *[other] { $count } students were in it.
    } Its address and code stay the same.
class-forget = Delete the class and its labs
class-forget_sure = Delete the labs of all students of this class, with everything that is stored of them, and end the class? It cannot be undone. Open pages start again with a new lab.
class-forgotten =
    { $count ->
        [0] No labs were deleted.
        [one] 1 lab was deleted.
       *[other] { $count } labs were deleted.
    }
class-picked = Sketches to show
class-picked_hint = Numbers such as 2, 5; empty for all
class-whereabouts = { $ended } at the end of the lesson, { $elsewhere } elsewhere
pace-title = Pace
pace-first = From step
pace-last = To step
pace-keep = Keep the class within these steps
pace-end = Let the class go anywhere
pace-none = The class may go anywhere.
pace-kept = The class may go from step { $first } to { $last } of { $lesson }.
gains-title = Gains
gains-axes = Axes
gains-pair = { $across } and { $up }
gains-scatter = Everyone's gains
gains-border = border between swinging (below) and creeping (above)
gains-students =
    { $count ->
        [one] 1 student
       *[other] { $count } students
    }

## The two sides; the names of the control laws stand in models/

side-left = left
side-right = right
side-title = { $law }, { $side }

aim-theta = aims at the closest point
aim-theta_ref = aims at its reference point

## The page: what is always there

connect-no_webgl = The robots are not drawn: this browser has no WebGL 2, or it is switched off. Everything else works.
connect-course_link = To the course
connect-picture_lost = The picture of the robots was lost; the lab goes on. The picture comes back by itself; if it does not, load the page again.
connect-opening = Connecting to the lab …
connect-building = The lab is preparing your page. When many come at once, this takes a little longer.
connect-loading = The picture of the robots is being loaded. Everything else works already.
connect-picture_back = The picture of the robots is being restored. Everything else goes on.
connect-back = The lab was interrupted or restarted. You are back in a few seconds.
connect-slow = The lab is slow at the moment: its computer is busy, or the connection is bad. Nothing is lost.
connect-silent = The lab does not answer. Is it still running? This page keeps trying to reach it.
connect-blocked = The lab answers, but its connection does not open. It may be full, or a proxy in between does not pass websockets on: assets/deploy/README.md shows how. This page keeps trying.
connect-offline = This device has no connection to a network. The page goes on by itself as soon as there is one.
connect-lost = The connection to the lab is lost. What you see stands still; the page keeps trying to reach the lab.
connect-forbidden = This lab does not let pages of { $origin } connect. Open it at its own address, or ask whoever runs it to allow this one (--origin).
connect-refused = The lab keeps refusing this page. Load the page again; if that does not help, tell whoever runs the lab that its proxy may lead one page to several processes.
connect-version = The lab has another version now. Load the page again; your lab has kept everything.
page-scene = Two robots that follow a path, seen from the front. What they do is announced as it happens; the keys of the lab are under “Help and keys”.

spoken-running = Running.
spoken-paused = Paused.
spoken-held = Held back.
spoken-on_path = Both on the path.

display-title = Language, display
display-speaks = Say what happens, for screen readers
display-sounds = Distance as sound: left robot in the left ear, right robot in the right
breakdown-slowly = Show it slowly
breakdown-end = Stop showing it
breakdown-reset = Reset with the same settings
breakdown-earlier = Reset with { $changes }
summary-clock = Time { $time } seconds. Path: { $path }.
summary-robot = { $robot }: { $now } millimetres from the path, { $most } at most, { $speed } millimetres a second along it.

code-copy = Copy
code-copied = Copied

readout-paused = t = { $time } s, paused
readout-running = t = { $time } s, running at { $speed }×

caption-torn_off = torn off: up to { $mm } mm
caption-held = held back: up to { $mm } mm
caption-waits = waits: up to { $mm } mm
caption-pulled = pulled: { $mm } mm
caption-pulled_far = pulled: { $mm } mm, pulls straight back
caption-pulled_bounded = pulled: { $mm } mm, its integral action saturated
caption-returns = far off, goes straight back: { $mm } mm
caption-off_bounded = off the path: { $mm } mm, its integral action saturated
caption-chases = chases its point: { $mm } mm
caption-off = off the path: { $mm } mm
caption-stopped = stopped
caption-at_end = at the end: press Reset
caption-spoken = { $robot }: { $caption }.

stage-building = { $robot }: the picture is being built …
stage-paused = Time stands still
stage-past = Looking back at { $time } s

invite-hold = Two identical robots follow the same path. What if something stands in their way? Press “Hold both back”.
invite-let_go = The tracker’s ring ◯ runs on by its clock and tears it off the path. The follower’s dot ● waits with it. Now let both go.
invite-pull = Now be the obstacle yourself: press on a robot’s tip and keep still, with the mouse or a finger. One hand acts on both.
invite-pulled = Held still, the follower waits at your hand, and the clock drags the tracker on. Pulled outwards, both leave the path: such a hand does not hold them back.
invite-bend = Bend the path: drag one of its grey points.
invite-lesson = What happens while a robot is held for two seconds? Predict it in lesson 1, and then see.
invite-lesson_button = Open lesson 1
invite-skip = Skip the introduction

scene-draw = Draw the path in one stroke
scene-force = force { $force } N
scene-true_scale = true scale
scene-larger = deflection drawn { $factor }×

robots-choose = Choose a robot
robots-illustrative = The numbers of the robots that come with OnPath are illustrative, not those of particular machines.

laws-left = Left robot
laws-right = Right robot
laws-hint = The robot moves on from where it is, under this law
laws-own = Own law…
laws-own_left = Own law of the left robot
laws-own_right = Own law of the right robot
laws-own_hint = Enter uses the law; Shift and Enter begin a new line
laws-about = About the laws
laws-bounds = Every law's integral is limited: K3 shifts the equilibrium by at most { $reach } mm, and in a bend by half of its radius, so that no hand can wind it up. Laws that follow the path by its closest point return straight to it, with K1 and K2 alone, where that point is not to be trusted: half of the radius of curvature away on the inner side, fully from four fifths on, where it or the path’s direction there turns 0.15 to 0.3 rad more than wanted in the time from measurement to torque, and 5 to 20 mm past an open end.
laws-source = Source: { $source }
laws-own_text = A line across = … gives the acceleration across the path in m/s², a line along = … that along it in rad/s²; or u1 = …, u2 = … give the torques of all motors in N m.
laws-own_space = On a robot that moves in space, across2 = … is the acceleration along the second normal.
laws-own_language = A formula consists of numbers, the names below, + - * /, ** with an exponent from 0 to { $most }, { $functions }, and a if xi > 0 else b, where a condition may have and, or and not.
laws-name = Name
laws-meaning = Meaning
laws-unit = Unit

run-hold_both = Hold both back
run-hold = Hold back
run-let_both_go = Let both go
run-let_go = Let go
run-hold_hint = Holds the end-points back until you press again. Keep it pressed, and it lets go when you do. Key: H
run-run = Run
run-pause = Pause
run-run_hint = Stops or resumes simulated time. Key: space
run-step = Step
run-reset = Reset
run-view = Reset view
run-view_hint = Shows the robots from the front again
run-rate = Time runs at

controls-help = Help and keys

## The wall and the start

wall-title = Wall
wall-forces = Force on the wall

start-title = Start
start-show = Show it, to drag it
start-show_hint = A green ball in the scene: where the next run starts; its arrow is the velocity. While it is shown, the links of a robot from a file can be dragged, too: each turns its joint there
start-reset = Reset to it
start-reset_hint = Restarts the run from this start
start-default = On the path
start-default_hint = Puts the start back onto the path, at rest

## The path

design-path = Path
design-path_hint = Both robots follow it. Drag its points in the scene to bend it.
design-own = a path of your own
design-refused = { $path } (is refused)
design-ambiguous = { $path } (crosses itself)
design-draw_hint = Then draw one stroke around a robot, with the mouse or a finger. If it ends near its beginning, the path is closed; otherwise the robots raise their pens and begin again. Press again to cancel.
log-title = Log of an arm
log-hint = What a real arm has logged, at most { $most } MB: a table (CSV) with times, joint angles and torques, or arrays of NumPy or MATLAB. It is drawn over the plots, from the beginning of each run on. The arm must be of the kind that is simulated here.
log-choose = Log of an arm …
log-file = Choose a log
log-none = none
log-which = which column?
log-column = Column of { $name }
log-unit = Unit of { $name }
log-unit_hint = A unit, or what one unit is in SI units, such as 0.085 for a current in amperes
log-instead = It is the log of an arm
log-drawn = { $file } is drawn over the plots, from the beginning of each run on: Reset begins one.
log-shown = { $file } is drawn over the plots, from the beginning of each run on.
log-shown_in_part = What { $file } has under its first law is drawn over the plots, from the beginning of each run on.
log-after_lesson = { $file } is drawn over the plots as soon as no lesson is open.
design-files = From a file
design-size = Size [mm]
design-size_hint = The larger side of the path; 0 leaves the lengths as they are in the file
design-radius = Corners’ radius [mm]
design-radius_hint = Arcs of this radius take the place of corners; 0: corners are rounded only as much as the robots need
design-pace = Up to { $speed } mm/s along the drawing, slower in bends.
design-open = Open path
design-open_hint = The end is not joined to the beginning; otherwise as the file says, and points are joined
design-upload = Choose a file
design-upload_hint = Points (CSV), a drawing (SVG) or G-code, at most { $most } MB; you can also drop it on the page or paste it. All lines are drawn one after the other; press one to have it alone.
design-lines = The lines of the file
design-parts = Lines
design-parts_hint = Which lines of the file are followed, such as 1, 3; empty: all of them. Pressing a line in the picture adds it or takes it away.
design-turn = Turn [°]
design-turn_hint = Anticlockwise
design-right = Middle, right [mm]
design-right_hint = Where the middle of the path is, along the first axis of its plane
design-up = Middle, up [mm]
design-up_hint = Where the middle of the path is, along the second axis of its plane
design-chosen = { $file } was chosen last. Changes act on it at once.
design-not_followed = It cannot be followed: { $reasons }. The places are marked on the stage; the path is as it was.
design-larger = Larger: { $size } mm
design-smaller = Smaller: { $size } mm
design-both = Larger, { $size } mm, with corners rounded to { $radius } mm
design-rounder = Round the corners to { $radius } mm
design-followed = The robots follow { $file }; Undo takes it back. What you change below acts on it at once.
design-reading = The file is being read.
design-undo = Undo
design-undo_hint = Undoes the last change to the path
design-redo = Redo
design-redo_hint = Makes the undone change again
design-add = Add
design-add_hint = A new point of the path, after the selected one
design-remove = Remove
design-remove_hint = Takes the selected point out of the path
design-selected = Selected
design-no_point = none
design-coordinate = { $name } [mm]
design-coordinate_hint = Where the selected point is, in the plane of the path
design-arrows = The arrow keys move the selected point by 1 mm; N selects the next one. To drag a point that the end-point covers, select it first.
design-slanted_circle = ellipse of (23)
design-rank = Rank test (11) along the path: at least { $number } of 1.
design-zone = Show singular zone
design-zone_hint = Where the arm is stretched or folded, eq. (14)

## Gains and realism; the names of the parameters themselves stand in models/

gains-defaults = Reset to defaults
gains-defaults_hint = Sets the robot and its laws back to their usual values
gains-across = Across
gains-along = Along
gains-pulse = Test pulse
gains-pulse_hint = Pulls both end-points across the path for an eighth of a second, to show what the gains do
gains-rate = decay [1/s]
gains-swing = swing [rad/s]
gains-poles = poles { $poles } 1/s
gains-poles_at = poles { $poles } 1/s at θ = { $place }°; they vary along the path
gains-identify = Identify M and b
gains-identify_hint = Estimates M and b from the right robot's last 3 s and uses them in the model of both controllers.

## The flexible link

flexible-pull = Pull in
flexible-pull_hint = The plane, through the tip, in which the mouse pulls it
flexible-beam = Beam and plant
flexible-composite = Composite control
flexible-computing = critical α: being computed
flexible-none = critical α: none up to 1
flexible-critical = critical α = { $critical }, here and at rest
flexible-critical_on_path = critical α = { $critical }, the least on this path, at rest
flexible-of_beam =
    { $modes ->
        [one] 1 mode
       *[other] { $modes } modes
    }, each with ζ = { $zeta }
flexible-unstable = zero dynamics unstable
flexible-deflections = Deflection: { $each }; { $scale }
flexible-deflection = { $robot } { $value } mm
flexible-drawn = drawn { $factor }×

pull-path-s-plane = path's plane
pull-horizontal-plane = horizontal plane

## What is shown in the scene on demand

show-labels = Labels, axes
show-labels_hint = Angles q, lengths ℓ and the axes of y, as in the paper's figures 1 and 4
show-tube = Tube
show-tube_hint = Where the closest point of the path is unique: the virtual output is defined there
show-grid = Grid along and across the path
show-grid_hint = Lines across the path have the same closest point and so the same θ; lines along it the same distance ξ.
show-rank = Where the laws are defined
show-rank_hint = How far each place is from losing rank, where the control laws are no longer defined
show-errors = Both errors
show-errors_hint = e (orange) leads to the timetable's point, the ring of the left robot; d (blue) leads to the closest point of the path.
show-mass = Effective mass
show-mass_hint = How heavy the end-point feels in each direction: the radius goes with the square root of the mass, and 6 cm stand for 1 kg.
show-width = The closest point is unique up to { $width } mm from the path.
show-width_none = The path is straight: the closest point is unique everywhere.
show-steps = Lines every { $xi } mm of ξ and every { $theta }° of θ.
show-rank_scale = Smallest singular value of (∂h/∂q) g_v: acceleration of the output per torque, in the direction in which it is least, in (m/s²)/(N m). At 0 the rank is lost, eq. (11).
show-rank_alpha = With α = { $alpha } and a straight link.

## Plots: names in the list, then titles with units

plots-menu = Plots
plots-menu_hint = Which quantities are plotted
plots-time = Time, plots
plots-time_hint = How fast time runs, and which quantities are plotted
plots-theta_ref = wanted θ

plot-phase = phase plane (ξ₁, ξ₂)
plot-phase_name = Phase plane: ξ₂ over ξ₁ of both robots in the last 3 seconds. The origin is the path.
plot-distance = distance from the path
plot-speed = speed along the path
plot-torques = torques
plot-forces = forces of the motors
plot-mixed = torques and forces of the motors
plot-across = ξ₁ across
plot-across_rate = ξ₂ rate across
plot-place = η₂¹ = θ place along
plot-rate = η₂² = θ' rate along
plot-modes = η₁ modes of the link
plot-deflection = deflection of the tip
plot-energy = internal energy
plot-force = force

axis-distance = distance from the path [mm]
axis-speed = speed [mm/s]
axis-torques = torque [N m]
axis-forces = force of a motor [N]
axis-mixed = torque or force of a motor [N m, N]
axis-across = ξ₁ [mm]
axis-across-space = ξ₁, ξ₃ [mm]
axis-across_rate = ξ₂ [mm/s]
axis-across_rate-space = ξ₂, ξ₄ [mm/s]
axis-across-level_set = ξ₁ = s(y) [mm²]
axis-across_rate-level_set = ξ₂ = s'(y) [mm²/s]
axis-place = η₂¹ = θ [rad]
axis-rate = η₂² = θ' [rad/s]
axis-modes = η₁: each mode, at the tip [mm]
axis-deflection = deflection [mm]
axis-energy = energy in the link [mJ]
axis-force = force [N]

## The last minute, and files

past-go_on = Go on from here
past-undo = Restore what was discarded
past-undo_hint = Reverses “Go on from here”, and sets aside what was done since. Key: U

export-title = Export
export-table = CSV, last 60 s
export-picture = Picture of the plots
export-lines = Picture of both lines
export-film = Recording (HTML), last 10 s
export-caught = Ring: where the robot was caught and held
export-making = Making { $name } …
export-busy = One file at a time: the last one you asked for is still being made.
export-ready = { $name } is ready.
export-failed = { $name } could not be made.
export-nothing = There is nothing to export yet: let it run first.

## The comparison of laws

compare-title = Compare laws
compare-text = The same robot, path, speed and gains for all, and one obstruction. The wanted speed is constant. The robots are simulated in the background, with the parameters that this lab has now; your lab goes on.
compare-obstruction = Obstruction
compare-run = Compare
compare-count = Choose one to { $most } laws.
compare-law = Law
compare-distance = largest distance from the path  [mm]
compare-delay = delay at the end  [s]
compare-force = largest force  [N]
compare-stopped = stopped
compare-stopped_text = “stopped”: at one or more of the places, the motion diverged and the simulation was ended.
compare-picture = Largest distance from the path over delay at the end, for each law
residuals-torque = torque, filtered
residuals-left = not explained
compare-path = A comparison needs a closed path and a speed along it other than 0: choose such a path, and the task speed.
obstruction-none = nothing
obstruction-brake = held for 2 s, at eight places
obstruction-push_across = pulled across the path
obstruction-push_ahead = pulled ahead
obstruction-push_back = pulled back
obstruction-wall = a wall in the way
obstruction-weak_motors = weak motors
obstruction-weak_motors_cut = weak motors, torques cut
obstruction-too_fast = twice the speed, limited motors
obstruction-too_fast_cut = twice the speed, torques cut
obstruction-start_off_at_rest = start beside the path, at rest
obstruction-start_off_moving = start beside the path, moving

## The exported picture

figure-history = { $robot }, path: { $path }. The last { $seconds } s
figure-xi_means = ξ: signed distance of the end-point from the path; 0 on the path
figure-level_set_means = ξ = s(y): a function that is 0 on the path
figure-eta1_means = η₂¹ = θ: place of the closest point, along the path
figure-eta2_means = η₂²: how fast that place moves along the path
figure-u_means = u: what each motor gives
figure-motor = motor { $number }
figure-law = change of law
figure-held = held back
figure-film = Settings and plots
figure-distance =
    distance from
    the path  [mm]
figure-torques = torque $u$  [N m]
figure-forces = force $u$  [N]
figure-mixed = $u$  [N m, N]

## Keys and help

key-run = Run or pause
key-right = One step; with a point selected, move it right
key-left = Move the selected point left
key-up = Move the selected point up
key-down = Move the selected point down
key-reset = Reset both robots
key-hold = Hold back, or let go
key-next = Select the next control point
key-none = Select no point
key-add = Add a control point after the selected one
key-remove = Remove the selected control point
key-undo = Undo a change of the path
key-redo = Redo a change of the path
key-pull_left = Pull the end-points left
key-pull_right = Pull the end-points right
key-pull_up = Pull the end-points up
key-pull_down = Pull the end-points down
key-let_go = Let the end-points go
key-wall = Place a wall, or take it away
key-wall_left = Move the wall left
key-wall_right = Move the wall right
key-wall_up = Move the wall up
key-wall_down = Move the wall down
key-wall_turn = Turn the wall counter-clockwise
key-wall_turn_back = Turn the wall clockwise
key-back = Look back one more second
key-forward = Look forward one second
key-go_on = Go on from the moment shown; discard what came after
key-undo_go_on = Restore what was discarded by going on from the past
key-slowly = After a robot has stopped: show its last moments slowly
key-earlier = After a robot has stopped: reset with the last settings that worked
key-summary = Say what is on the screen
key-view = Reset the view
key-lesson = Open the first lesson

keyname-space = space
keyname-Esc = Esc
keyname-Ins = Ins
keyname-Del = Del
keyname-Home = Home
keyname-Ctrl = Ctrl

help-title = How to use the lab
glossary-to_terms = Glossary: from the lessons' words to the field's terms
glossary-to_words = Glossary: from the field's terms to the lessons' words
glossary-lesson = (Lesson { $number })
help-close = Close

## Routes through the lessons

route-route = Route
route-send = Open this route for all
route-follow = Follow this route
route-stop = { $lesson }, steps { $first } to { $last }, { $minutes } min
route-here = { $route }: part { $stop } of { $stops }, to step { $last }, { $minutes } min

## The teacher's guide and the worksheets (app/exports/guide.py)

guide-title = Teacher's guide
guide-intro = First an hour with a class, then what each lesson asks, in its order, with the answers. Let the class commit to every prediction before it is seen, ask what is suggested here, let neighbours discuss, and only then run it. The letters are those of the presentation; a worksheet has its own, which its key has, too, and students' own labs show the options in another order.
guide-assumed = None of this has been measured in a class. The minutes are estimated from the lessons' words, runs and tasks; what students may draw or say is what the authors expect; and how much students learn is not known. The concept test lets you measure that in your own class.
guide-cite = To cite: for the theory, Hladio, Nielsen, Wang: “Path following for mechanical systems: experiments and examples”; for lessons, figures and runs, OnPath, version { $version }.
guide-hour = An hour with a class
guide-before = Before
guide-begin = Start the class with the line above, on a computer that stays on and is in the students' network. You get the address of the class, also as a QR code, and the teacher's key when you press Enter; both are the same at every start.
guide-key = Open the address, press { $teacher } where a nickname is asked for, and type the key.
guide-reach = Open the address on a phone, too. If nothing comes, a firewall blocks the port, or the network keeps devices apart, as many guest networks do: then you need another network, or a server that everybody can reach (assets/deploy/README.md).
guide-places = Each open page takes a place, a student's second tab, too. There are 80 (--most-clients), at most 75 of them for one network. Whoever finds none waits until one is free. A computer with two cores has served sixty pages.
guide-plain = Nothing is encrypted: whoever listens in the network can read the answers, and your key when you type it. SECURITY.md has the two lines that change this.
guide-kept = Of each student, the computer keeps the nickname, predictions and drawn curves, answers, also in own words, tasks, gains, and the time of the last use; a real name or an address only if you ask for one. You see all of it under the nickname; other users of the computer cannot open the file. The class with its nicknames is deleted a week after its last change (--keep-class-days), a student's lab a year after its last use, and either one earlier if you or the student wants. With --privacy-url and an address, a link to your privacy notice stands where the nickname is asked for.
guide-paper = Print a worksheet for everybody, two to four pages (--variant 0 has the letters of the projector), and for yourself its key and this guide, of the lessons that you need:
guide-offline = Without a network, the first line opens the lab on your computer, for the projector, and the class votes with raised hands or on worksheets. The second one writes the lessons as pages for a memory stick or any web server:
guide-lecture = Among these pages, lecture.html is a lecture of 20 minutes, with notes for you.
guide-during = In the hour
guide-wall = Students open the address and type a nickname. On your page, { $class } has two links: { $wall }, and { $remote }. The wall has the address, the question and, once you show them, the answers; it follows you.
guide-send = In { $predictions }, choose a route and press { $route }, or a lesson and a step and press { $step }. It also comes to those who join later.
guide-vote = When a question is open, the answers are counted. { $show } closes the vote after five seconds, or as soon as all have answered. Below 30 % right, explain; up to 70 %, let neighbours discuss, and press { $again }; above, go on.
guide-next = { $next } takes everybody to the next step, where the students let happen what they have predicted. { $play }, in { $predictions }, does it on your robots. { $freeze } turns all eyes to the front.
guide-trouble = A page that has lost its connection comes back by itself, or when it is loaded anew, with all that was answered. Whoever changes the device types the same nickname again; { $yes }, in { $class }, gives the place back. If your computer stops, start the same line again: the class goes on where it was.
guide-after = Afterwards
guide-record = { $export }, in { $record }: a workbook with a row for each answer and its time.
guide-marks = Decide on marks before the hour: { $asks } an e-mail address, an ID number or a user name, in { $record }, since the students type it, after a press on their own name. The workbook then has a sheet for Moodle with the share of each lesson's questions that were answered, right or wrong. What was right is marked by a learning platform that has the lesson as a package:
guide-end = { $end } deletes nicknames and record, { $forget } the students' labs, too. Save the workbook first.
guide-needs = Prerequisites
guide-goals = Afterwards the students can
guide-misconception = The misconception
guide-timing = Step
guide-minutes = Minutes
guide-and_optional = and { $minutes } optional
guide-sketch = Prediction: a curve
guide-choice = Prediction
guide-quiz = Question
guide-number = Question, a number
guide-within = { $number } { $unit }, within { $tolerance } { $unit }
guide-derivation = Derivation, line by line
guide-open = Question, in the student's own words
guide-reasons = Reasons to choose from:
guide-task = Task
guide-ask = Ask before it is seen:
guide-usual = Students may draw:
guide-second = Asked after a wrong answer, before what is right is told:
guide-distractors = What students may say, and the answer to it:
guide-answer = What happens:
guide-right = Right:
guide-wrong = Known mistake:
guide-curves = The true curves of both robots
guide-solution = A solution
guide-why = Why it works:
guide-otherwise = Passed otherwise:
guide-exploratory = found by trying, not graded
guide-test = Concept test
guide-test_intro = Two forms with other questions about the same beliefs. Half of the class answers form A before the course and form B after it, the other half the other way round; that is dealt by chance. Open the test for the class on the page “Predictions”; the answers are shown when the second one is handed in, so do not discuss them before. From twenty students on, the class's normalised gain, and how hard each question is and how well it tells students apart, are on the same page and in the class record, with intervals and without names. On 30 November 2026, three readers who know control theory, had not written the questions and did not know the course agreed with every right answer, and so did three others once the questions had been reworded; what those found unclear has been reworded since. No student has been measured yet: that the two forms are equally hard, and that the questions work, is assumed.
guide-test_one = The same questions before and after the course. Open them for the class on the page “Predictions”; the answers are shown when the second test is handed in, so do not discuss them before. The class's normalised gain is then, from twenty students on, on the same page and in the class record, without names.
guide-test_apart = The concept test and its answers are not in this guide, so that the guide may be passed on: `onpath lessons guide --concept-test` adds them. No student has been measured with this test yet.
guide-test_when = It takes { $minutes } minutes before the first hour, and as many after the last. Students find it in { $lessons }, as the last two entries, also at home if your computer can be reached from there. Or open it for all: in { $predictions }, choose the lesson { $before } or { $after }, and press { $step }. Then everybody goes through it alone, and hands it in. A class that nobody uses for a week is deleted: if there are longer breaks between the two tests, start with --keep-class-days 120.
guide-treated = Treated in:
guide-page = lesson { $lesson }, page { $step }
guide-transfer = about other bodies than those of the lessons
guide-aims = Aims at the belief:
guide-at = at { $time } s: { $what }
guide-pull = pull by { $right } mm to the right and { $up } mm up
guide-move = move control point { $index } by { $right } mm to the right and { $up } mm up
guide-run = run
guide-pause = pause
guide-rate = simulated time at { $rate } times the speed of the clock
guide-start = start elsewhere
worksheet-title = Worksheet: { $lesson }
worksheet-key = Key: { $lesson }
worksheet-variant = Variant { $number }
worksheet-name = Name
worksheet-date = Date
worksheet-axes = Axes to draw on
worksheet-because = Because
worksheet-sure = How sure?
worksheet-after = tasks and questions
worksheet-done = What worked, and why:
worksheet-learnt = What I thought before, and think now:

## What the lab says by itself

say-stopped = { $robot } stopped at { $time } s: { $reason }. Reset starts the run again.
say-slowly = { $robot } stopped at { $time } s: { $reason }. Its last moments, slowly.
say-slowly_larger = { $robot } stopped at { $time } s: { $reason }. Its last moments, slowly; bending is drawn { $larger } times as large.
say-refused = This path is refused: { $reasons }. The previous one is kept.
say-ambiguous = Note: { $reasons }. These laws go on along the strand on which they are; one that searched the whole path might jump to the other.
say-deviates = The path is smooth: at some places it is { $deviation } mm away from the lines between the given points.
say-deviation = The path keeps within { $deviation } mm of the drawing.
say-no_further = The path goes no further: { $reasons }.
say-level_set_ends = This path has no level set: across it, the distance is measured again.
say-begun_anew = With this change, both robots have restarted.
say-ramps_at_start = The speed ramps up from the start of a run: press Reset to see it.
say-nothing_to_undo = There is no change of this path to undo. Each robot keeps a path of its own.
say-nothing_discarded = Nothing has been discarded that could be restored.
say-pull_paused = Time is paused. The hand pulls when it runs again.
say-nothing_to_redo = There is no change of this path to redo.
say-select_first = Select a control point first: press on one, or choose its number.
say-laws_replaced = Not for this robot: { $laws }. A usual law is in its place.
say-law_interpreted = This law is interpreted instead of compiled, which takes about 30 times as long: { $reason }.
say-looking_back = This is the past. “Back to now” returns to the present; “Go on from here” discards what came after, and can be undone.
say-let_go = The end-points have been let go.
say-waits = The lab is still working on what was asked; it goes on in a moment.
say-present = Back in the present.
say-set_up = The lab is set up from the code. Undo in the path editor restores the previous path.
say-went_on = Going on from { $time } s. The { $seconds } s that came after are discarded until you press “Restore what was discarded”.
say-brought_back = Back at { $time } s, as it was before going on. What was done instead is set aside; “Restore what was discarded” changes back to it.

identified-found = From the right robot's last { $seconds } s: { $values }.
identified-value = { $value }, previously { $before }
identified-and = { " " }and{ " " }
identified-limited = { " " }{ $names }: limited by the range of the model's settings.
identified-also = { " " }Also present, but not in the controllers' model: { $values }.
identified-unexplained = { " " }{ $percent } % of the torque is not explained.
identified-other_robot = Identification works with the five-bar linkage only: choose that robot first.

report-title = Record of my lessons
report-made = Made on { $date }
report-date = %Y-%m-%d at %H:%M
report-code = lab code { $code }
report-point = .
report-none = No lesson has been opened yet.
report-lesson = Lesson
report-seen = Steps seen
report-tasks = Tasks passed
report-made_of = Predictions made
report-right_of = Choices right
report-part = { $part } of { $all }
report-gone = A lesson that was begun is no longer in the course: { $name }.
report-strange =
    { $count ->
        [one] 1 note that no longer fits this lesson is left out.
       *[other] { $count } notes that no longer fit this lesson are left out.
    }
report-predictions = Predictions
report-to_do = Tasks
report-questions = Questions
report-not_predicted = You have not predicted anything yet.
report-not_happened = What really happens has not been seen yet.
report-not_passed = Not passed yet.
report-not_answered = Not answered yet.
report-chosen = You chose:
report-right = Correct answer:
report-curve = { $robot }: { $quantity }
report-drawn = Your curve has its peak of { $value } { $unit } at { $time } s.
report-happened = What really happened has these peaks: { $first } and { $second }.
report-peak = { $robot } { $value } { $unit } at { $time } s

## How an error of the controller's model dies out (models/control/poles.py)

behaviour-settles = settles in { $seconds } s, { $kind }
behaviour-no_overshoot = no overshoot
behaviour-no_oscillation = no oscillation
behaviour-damping = damping { $damping }
behaviour-unstable = unstable: an error grows by a factor of e every { $seconds } s
behaviour-not_stable = not stable: an error never dies out
behaviour-swings = not stable: an error swings for ever
behaviour-free = like a bead on a wire: the speed gained in one place is lost in another, over a lap
behaviour-no_poles = poles are not computed for this law
behaviour-not_constant = no poles: the law depends on the place or on the time, or commands torques
behaviour-not_smooth = no poles: on the path, the law has a kink or a jump, or does not stay
behaviour-coupled = no poles: the motions across and along the path act on one another

## Why a curve cannot be a path (models/paths/curve_faults.py)

fault-not_numbers = the curve has points that are not numbers
fault-outside = the path leaves the workspace: the arm cannot reach there
fault-singular = the path comes too near a singular configuration: there the arm is stretched or folded and cannot move in every direction
fault-bends = the path bends too sharply: a bend needs a radius of at least { $radius } mm, otherwise the closest point on it is not unique nearby
fault-cusp = the path has a cusp, where it has no direction
fault-crosses = the path crosses itself: at the crossing, the closest point is not unique
fault-narrow = two strands of the path are closer to each other than { $least } mm: between them the closest point is not unique

## Why a robot has stopped (the models' `fault`)

stop-range = the numbers have left the range of a computer
stop-typed_law = the typed law gives a number that is not finite, or is larger than { $most }
stop-own_law = { $law } gives a number that is not finite, or is larger than { $most } ({ $file }, line { $line })
stop-called_law = { $law } has been stopped: { $reason } ({ $file }, line { $line })
stop-fast = a joint turns faster than { $limit } rad/s: the motion has diverged
stop-collapsed = the linkage has collapsed (all links in one line): the controller cannot bring it out of a singular configuration
stop-singular = the robot is close to a singular configuration (two links in one line): there its motors cannot move the end-point in every direction
stop-limit = the robot is close to a singular configuration or to the end of a joint's travel: its motors cannot move the end-point in every direction
stop-joint = the joint { $joint } has passed its limit of { $limit }
stop-joints = a joint has passed its limit
stop-crushed = a slide has struck the end of its travel harder than its buffer can bear
stop-bent = the link bends too far although its zero dynamics are stable: the pull is too strong, the control too slow or the controller's model too wrong
stop-unstable = the output is on the path, the inside is not: unstable zero dynamics
stop-bent_or_unstable = the link bends too far: its zero dynamics are unstable, the pull is too strong, the control too slow or the controller's model too wrong
stop-because = { $reason }. Likely cause: { $causes }
refused-not_started = the controller has not been started
refused-time = the time of the measurement is not a number, or is earlier than the last one
refused-late = no measurement came for two control intervals
refused-not_finite = a measured number is not finite
refused-jump = a measured joint has jumped farther than it can move
refused-fast = a joint is faster than the limit that was set for the controller
refused-no_torque = the law gave a number that is not finite
refused-stopped = somebody has stopped it
efforts-stated = Largest torques of the motors by its file: { $limits }.
efforts-exceeded = the motor of { $joint } gave { $gave }, more than the { $limit } that the robot's file states; with a torque limit of 100 % it gives no more
caution-flexible = With { $rate } control actions a second, the flexible link is not even stable untouched: it will stop within seconds. Choose at least { $slowest } Hz
caution-flexible_weak = Behind encoders or noise, the law for the tip of the flexible link asks for more than { $limit } N m: the tip may swing, and the robot stop. Choose a higher limit, or none
forecast-singular = the decoupling matrix is singular at the start: from rest there, the motors cannot accelerate the output in every direction, so that no torques give the motion that the law asks for
forecast-no_rest = the robot cannot rest at the start: its coordinates without a motor begin to move, whatever the motors do
forecast-unstable = the zero dynamics are unstable: while the output stays on the path, the motion of the coordinates without a motor grows, at first tenfold every { $time } s (exponent { $rate } 1/s)
forecast-exhausted = standing still on this path already takes { $share } % of the torque limit, for gravity and for what the errors of the sensors ask for. Too little is left for the motion: the robot may leave its path and stop
forecast-unplanned = on a drawing, time-optimal laws keep to the wanted speed: a drawing has more bends than their plan of the fastest speed can hold
forecast-unmodelled = path following may get farther from its path than the tracker here: its velocities come from the controller's model, and there is an error in it, a payload, friction, a delay or a torque limit
cause-poles_across = these gains are unstable across the path at this control rate and delay (lower K2 or K3, or raise the rate)
cause-poles_along = these gains are unstable along the path at this control rate and delay (lower K5, or raise the rate)
cause-limit = the motors were at their limit of { $limit } { $unit } (raise it, or lower the speed)
cause-small_errors = its reference point was { $away } mm away, and the law uses the axes of that point, which are meant for small errors
cause-force = a force of { $force } N acted on it
cause-far = it was at a place where the closest point is unreliable
cause-turned = it turned by { $turned } rad in a control interval (a faster controller helps)
cause-model = the controller's model is wrong (set the payload and the model's errors to 0)

## Refusals: a path's points

error-point_not_finite = a control point needs finite coordinates
error-too_many_points = a path has at most { $most } control points
error-too_few_points = this path needs at least { $least } control points
error-no_point = control point { $index }: there are { $count }
error-stroke_not_finite = a stroke needs finite points
error-stroke_without_points = a stroke needs points
error-points_coincide = a path needs at least { $least } points apart from each other
error-path_too_short = the path is too short: { $length } mm, at least { $least } mm
error-path_takes_no_numbers = the path { $name } takes no numbers
error-half_a_point = a point is incomplete: a path needs as many values of x as of y
error-points_out_of_bounds = 2 to { $most } points, within { $reach } m of the middle
error-no_drawing = the numbers of the path are not those of a drawing
error-coefficients = a drawn path has { $wanted } coefficients, not { $count }
error-implicit_lines =
    { $count ->
        [0] the equation has no solution within { $region } mm of the centre: one closed line is expected
        [one] the solutions of the equation are an open line, or leave the { $region } mm around the centre: one closed line is expected
       *[other] the solutions of the equation are { $count } lines: one closed line is expected
    }
error-implicit_shape = the solutions of the equation have a shape that a smooth path cannot follow: it is up to { $apart } mm off
error-no_level_set = this path has no level set s(y): only circles and ellipses have one here, and on the command line paths with an equation
error-level_set_crosses = this path crosses itself: at the crossing, a level set s(y) has no gradient; follow the path by its distance
error-level_no_polynomial = only a polynomial of z1 and z2 is followed by its level set; any path with an equation is followed by its distance
error-level_gradient = the path cannot be followed by this level set: { $beside } mm beside it, the gradient of s no longer points away from it, and the tube around the path is { $tube } mm wide
error-cannot_follow = { $robot } cannot follow this path: { $reasons }

## Refusals: numbers and names

error-start_out_of_reach = the robot cannot start there: the place is out of its reach, or too near to where it is singular
error-start_not_possible = the robot cannot start like this: { $reason }
error-no_such_joint = this robot has no such joint
error-set_by_process = only those who run this server can change this
error-not_a_number = that is not a number
error-not_a_point = that is not a point
error-value_out_of_range = { $name }: { $value } is not between { $low } and { $high }
error-value_not_a_number = { $name }: { $value } is not a number
error-decimal_comma = { $name }: write { $point } instead of { $value }
error-value_not_an_option = { $name }: { $value } is not one of { $options }
error-unknown_name = unknown { $kind } { $name }: { $hint }
error-law_does_not_suit = { $law } is not possible with this robot: it is made for other numbers of motors, outputs or coordinates
error-did_you_mean = did you mean { $names }?
error-there_are = there are { $names }
error-no_step = there is no step { $step } in this lesson: it has { $steps ->
        [one] 1 step
       *[other] { $steps } steps
    }

## Refusals: a law that is typed (models/control/laws)

error-no_translation = { $owner } uses the CasADi operation { $operation }, which cannot be translated to { $target }
error-law_fails = { $law } cannot be used here: { $reason } ({ $file }, line { $line })
error-law_of_file = { $law }: expected FILE.py:NAME, such as my_law.py:SlidingMode
error-law_no_file = there is no file { $file }
error-law_same_name = OnPath has a law named { $law }: choose another name
error-law_is_called = { $law } is a Python function, which is called in every control interval. That works in onpath.simulate, onpath experiment and onpath arena; here a law is an object with command(view)
error-controller_profile = A controller has no speed profile: set speed and ramp between its steps instead
error-controller_paths = The paths of a controller are all closed or all open, and all drawings or none
error-controller_differs = This needs another controller: what has changed is compiled into this one
error-law_cannot_run = a typed law is not possible with this robot and these settings
error-no_earlier_settings = there are no earlier settings to go back to
error-too_many_actions = a link has at most { $most } actions
error-law = line { $line }, column { $column }: { $reason }
error-law_too_long = a law has at most { $most } characters, not { $count }
error-law_too_complex = the law is too complicated: at most { $most } names, numbers and operations, nested at most { $deepest } deep
error-law_character = { $character } means nothing here
error-path_named = path { $name }: { $reason }
error-law_no_text = a law is a name of onpath.laws(), a text such as “across = -K1*xi - K2*dxi; along = 0”, FILE.py:NAME, a function, or an object with command(view), but nothing of type { $kind }
error-law_instead = write { $instead } instead of { $text }
error-law_not_a_number = { $text } is not a number; between the factors of a product there is a *
error-law_large_number = a number is at most { $most }
error-law_unknown_name = there is no { $name }: { $hint }
error-law_without_target = a line begins with one of { $names }, and then =
error-law_twice = there is a line for { $name } already
error-law_without_line = there is no line that begins with { $name } =
error-law_mixed = a law commands either accelerations or torques, not both
error-law_unreadable = something is missing or out of place here
error-law_not_finite = this is not a finite number
error-law_function_alone = { $name } is a function: write { $name }(…)
error-law_not_a_function = { $name } is not a function; between the factors of a product there is a *
error-law_arguments =
    { $count ->
        [one] { $name } takes one value in its brackets
       *[other] { $name } takes { $count } values or more in its brackets
    }
error-law_exponent = an exponent is a whole number from 0 to { $most }
error-law_condition_alone = a comparison stands only in a condition: a if xi > 0 else b
error-law_not_a_condition = a condition compares, such as xi > 0

## Refusals: identification

error-nothing_recorded = there is nothing to learn from yet: let it run for a few seconds first
error-hardly_any_data = there is hardly any data yet: let it run for a few seconds first
error-record_too_short = only { $duration } s of data: let it run for a few seconds first
error-hardly_moved = the arm hardly moved: let it follow a path with changing speed first
error-motion_too_regular = the motion was too regular to tell the parameters apart: change the speed while it runs, then try again
error-not_identifiable = { $name } cannot be told from this motion ({ $value } ± { $error } kg m²): let it follow a path with changing speed first

## Refusals: predictions

error-sketch_direction = draw a curve from left to right
error-sketch_without_points = a sketch needs points

## Refusals: tables in files

error-table_long_line = line { $line } is longer than { $most } characters
error-table_long = a table has at most { $most } lines
error-table_separator = line { $line }: { $text } separates no columns: a comma, a semicolon or a tab does
error-table_quotes = line { $line }: a quotation mark is missing or out of place
error-table_no_column = line { $line }: there is no column { $name }
error-table_no_names = line { $line }: the columns have no names, and { $name } is none of their numbers, 1 to { $last }: say which is which, as with --column t=1 --column q1=2
error-array_file = the arrays cannot be read: { $reason }
error-table_column_twice = line { $line }: there are several columns { $name }
error-table_cells = line { $line }: expected { $wanted } cells, got { $count }
error-table_empty = line { $line }: no rows follow the names of the columns
error-table_not_a_number = line { $line }, column { $column }: { $text } is not a number
error-table_large_number = line { $line }, column { $column }: { $text } is out of range
error-table_decimal_sign =
    line { $line }, column { $column }: { $text } differs from the numbers before it, which have a decimal { $other ->
        [comma] comma
       *[point] point
    }; digits cannot be grouped
error-record_of_another_robot = not a record of the robot { $robot }: { $reason }. If it is the log of a real arm, name its columns
error-in_file = file { $file }: { $reason }
error-record_without_laws = --law { $law }: { $file } has no column law
error-no_motion_there = { $robot }: it cannot swing about the place of this record, which is at a limit
error-record_of_one_row = line { $line }: a single row of a law is not a motion
error-record_times = line { $line }, column { $column }: the times do not grow from row to row: they may have been rounded; save the file again with more digits
error-record_coarse = column { $column }: a row comes every { $step } ms, and at most { $most } ms may pass between them
error-no_links = { $robot } is not a chain of links whose masses could be told apart: what its motion tells are the parameters that are printed
error-log_columns = say which columns are { $names }
error-log_factor = the factor of { $name } is { $value }: it must not be 0, and its size from 1e-12 to 1e12

## Paths from files (models/path_files)

say-raised = The pen is raised { $count ->
    [one] once
    [2] twice
   *[other] { $count } times
}: { $share } % of the time.
say-reordered = The lines are drawn in another order or direction than in the file, which keeps the pen up for less of the time.
say-gcode_words = These codes of the file have no effect on the path: { $words }{ $more ->
    [0] .
   *[other] {""} and { $more } more.
}
say-gcode_layer = The file prints { $count } layers, of which layer { $layer } is drawn. Choose another one with layer=2 and so on.
say-rounded = The tightest bend of the path has a radius of { $radius } mm.
say-repeats = { $count ->
    [one] A line repeats another one and is
   *[other] { $count } lines repeat others and are
} drawn once.
say-specks = { $count ->
    [one] A speck is
   *[other] { $count } specks are
} left out: smaller than a 500th of the drawing.
say-svg_filled = { $count ->
    [one] A small filled shape, such as a letter or a dot, is
   *[other] { $count } small filled shapes, such as letters and dots, are
} left out. To draw them, give them a stroke.
say-svg_left_out = { $what ->
    [image] Pictures in the drawing have no lines and are left out. To draw them, trace them (in Inkscape, Path > Trace Bitmap).
   *[text] Text in the drawing has no lines and is left out. To draw it, convert it to paths (in Inkscape, Path > Object to Path).
}
say-nearest = The path cannot be followed as it is: { $reasons }. The robots follow the nearest path found that they can; it is up to { $apart } mm away.
error-file_size = the file is larger than { $most } MB
error-file_empty = the file is empty
error-file_no_text = the file is not a text file
error-file_described = the file describes a path in words, which takes no options
error-file_points = line { $line }: more than { $most } points
error-file_corners = the line has too many corners: at most { $most } are rounded
error-file_no_line = the file has no line that could be a path
error-file_part = part { $part }: the file has { $count } lines
error-file_layer = there is no layer { $layer } with lines; the layers are { $names }
error-file_option = { $name }: { $value } is not possible
error-file_radius = a radius is for corners=round
error-file_too_large = the path reaches { $farthest } m from the origin, at most { $most } m is possible: state the unit, a scale, or fit=0.1
error-file_takes_long = reading the file took too long
error-file_failed = the file could not be read
error-file_busy = one file at a time: the last one is still under way
error-file_incoherent = the file did not arrive as it was announced: choose it again
error-file_late = the file took too long to arrive: choose it again
error-file_often = too many files in a row: wait a moment
error-points_columns = line { $line }: { $count } columns, of which none are called x and y
error-points_units = line { $line }: x and y have different units
error-gcode_word = line { $line }, column { $column }: { $text } is not read. Words are a letter and a number, such as G1 and X20.5; machines with axes other than X, Y and Z, and programs with variables, are not read
error-gcode_twice = line { $line }, column { $column }: { $text } repeats a word of the same line
error-gcode_both = line { $line }: { $text } contradict each other
error-gcode_plane = line { $line }: an arc in another plane than that of X and Y ({ $text })
error-gcode_changes = line { $line }, column { $column }: { $text } { $why ->
    [radius] moves the path aside by the tool's radius
    [origin] moves the origin to a place that the file does not state
    [turned] scales, turns or bends the path
    [program] runs another program
    [curve] is a curve that is not read
   *[unknown] is not known, and may change the path
}. Let the program that wrote the file write plain moves, G0 to G3
error-gcode_no_arc = line { $line }: I, J and R are for the arcs of G2 and G3
error-gcode_arc_form = line { $line }: an arc needs either its radius R, or I and J of its centre
error-gcode_arc_ends = line { $line }: the arc's ends are { $first } mm and { $last } mm away from its centre
error-gcode_radius = line { $line }: no arc with the radius { $radius } mm has these ends
error-signature = stroke { $stroke } of the signature has no points with x and y, as signature_pad's toData() gives them
error-signature_json = line { $line }, column { $column }: not JSON
error-svg_not_installed = drawings need svgpathtools and tinycss2: pip install "onpath[svg]"
error-svg_no_drawing = the file is not an SVG drawing
error-svg_no_xml = line { $line }, column { $column }: not XML ({ $reason })
error-svg_entity = line { $line }: the entity { $name } does not stand for plain text, and is not read
error-svg_grows = line { $line }: entities make the drawing much longer than the file
error-svg_styles = line { $line }: the drawing's style sheets have too many rules for its elements
error-svg_only = { $what ->
    [font] the file is a font, not a drawing: write text in it, and convert the text to paths (in Inkscape, Path > Object to Path)
    [image] the drawing is a picture, which has no lines: trace it (in Inkscape, Path > Trace Bitmap)
   *[text] the drawing is text, which has no lines: convert it to paths (in Inkscape, Path > Object to Path; in Illustrator, Type > Create Outlines)
}
error-svg_large = line { $line }: the drawing has more than { $most } elements, or more than { $deepest } nested in each other
error-svg_shape = line { $line }: this { $tag } cannot be read ({ $reason })

## Refusals: share codes and lab codes

error-share_too_long = This text is much too long: a share code has a few hundred characters.
error-share_missing = There is no share code in this text: it begins with ONPATH{ $version }-.
error-share_is_lab = This is the code of a lab, not of a set-up: type it into “Another code”.
error-share_newer = This share code was made by a newer OnPath: ask for that version.
error-share_incomplete = This share code is not complete: copy it again, to its last character.
error-share_mistyped = This share code is mistyped or cut off: its checksum does not match.
error-share_empty = This share code contains no set-up.
error-share_strange = This share code contains things that no lab has.
error-share_does_not_fit = This share code does not fit this version of OnPath: { $error }.
error-no_such_lab = there is no lab with this code
error-word_too_short = A word has at least { $least } characters.
error-number_is_gone = no phone shows this number any more; it has another one by now
error-lab_is_open = this lab is open in another window: close that one first
error-lab_code_length = a lab code has { $length } letters and digits, like { $example }
error-lab_code_letters = this is not a lab code: 0, 1, i, l and o do not occur in one; one looks like { $example }

## Refusals: what is kept in a database (app/storage)

error-database = the database reports: { $reason }
error-database_at = cannot use { $place }: { $reason }
error-database_keeps_breaking = the database fails again and again
error-database_busy = the database is busy
error-database_table = its table { $table } is not OnPath's
error-database_tables_newer = its tables ({ $revision }) were made by a newer OnPath, which is needed here
error-database_newer = it has version { $version } and was made by a newer OnPath, which is needed here
error-lab_newer = this lab was stored by a newer OnPath
error-lab_unreadable = the stored state of this lab cannot be read
error-not_storable = this cannot be stored: { $reason }
error-too_much_to_store = this is too much to be stored: { $size } MB, at most { $most } MB
say-robots_of_then = This lab was kept with robots from files that this server was not given: { $names }. It goes on without them; start the lab with --robot and the file to have them back.
say-laws_of_then = This OnPath does not have these laws or gains, which were kept with this lab: { $names }. It goes on without them.
say-path_of_then = The path kept with this lab is refused today: { $reasons }. The circle is used instead.
say-lab_kept = Your lab is kept, but cannot be opened now: { $reason }

## Refusals: the class

error-too_many_codes = too many wrong codes: wait a minute
error-hurry = one after the other: try again in a moment
error-not_the_key = this is not the teacher's key
error-not_the_class_code = this is not the class code on the projector; compare the address of this page, too
error-class_full = this class is full
error-no_nickname = a nickname has at least one character

## A form: assets/web/parts/form.ts

form-back = Back to { $value }, the default
form-back_lesson = Back to { $value }, as in this step
form-back_group = Set back: { $group }
form-changed = changed
form-count_on = { $count } on
form-is_on = on
form-off = off
form-no_number = That is not a number. It can be from { $low } to { $high }.
form-range = It can be from { $low } to { $high }.
form-differs = { $value } was not taken.
form-poles = The poles of the laws in the complex plane. Left of the axis a motion decays, right of it, it grows.
form-use = Use
form-group_setup = Set-up
form-group_hand = Hand and disturbances
form-group_gains = Gains and path
form-group_view = View
form-group_robot = This robot
form-section_motors = Motors
form-section_sensors = Sensors
form-section_friction = Friction
form-section_computer = Computer
form-section_load = Load
form-section_motion = Motion along the path
form-section_points = Control points
form-section_model = Errors of the model

## A figure without a server

standalone-path = Path
standalone-hint_hold_pull =
    { $robots ->
        [one] Hold the robot back, or pull its end-point.
       *[other] Hold both robots back, or pull an end-point, and compare.
    } Drag the line below to look back.
standalone-hint_hold =
    { $robots ->
        [one] Hold the robot back.
       *[other] Hold the robots back, and compare.
    } Drag the line below to look back.
standalone-hint_pull = Pull an end-point with the mouse or a finger. Drag the line below to look back.
# The parts, in the order of the run: standalone-recorded_start and so on
standalone-hint_raised = Where the path is dashed, the pen is up.
standalone-recorded = In the recorded run, but not on this page: { $parts }.
standalone-recorded_start = another start
standalone-recorded_profile = a speed profile
standalone-recorded_reverse = a reversal
standalone-recorded_hold = a hold
standalone-recorded_push = a pulling hand
standalone-recorded_wall = a wall
standalone-scene = The robot under the law { $law }, drawn from the side
standalone-law = Law
standalone-late = Time runs late: this device is too slow.
standalone-coincide = two control points would coincide
standalone-selected = Control point { $number } of { $all } is selected: move it with the arrow keys.
standalone-drag_hint = Drag the points of the path, or press N to select the next one and move it with the arrow keys.
standalone-no_script = This figure needs JavaScript, which is switched off here or forbidden by the Content-Security-Policy of the server.
standalone-only_picture = A picture of what was recorded. The robots do not move here: { $reason }
standalone-still = The robots at their largest distance from the path, and the distance over time: { $laws }
standalone-still_robot =
    { $law }
    up to { $far } mm from the path
standalone-refused = This figure does not run here: it needs WebAssembly. If your browser has it, the server forbids it: its Content-Security-Policy then has to allow 'wasm-unsafe-eval' in script-src. ({ $reason })
standalone-description = A simulation that runs in this page: { $laws }
standalone-about = { $product }, MIT licence. The theory: Hladio, Nielsen, Wang: “Path following for mechanical systems: experiments and examples”.

# The chart of distances, the lens and the buttons for time

chart-title = Distance from the path
chart-held = held
chart-pulled = pulled
chart-centre = centre of the circle
chart-table = As a table
chart-time = time [s]
chart-acts = held or pulled
chart-look = Look back
chart-look_hint = Drag to look back over the last minute; with keys: arrows, Page Up and Page Down, Home and End
chart-at = { $time } s: { $values }
chart-yours = Your prediction
chart-first = Your first curve
chart-log = Log
chart-remove_log = Remove the log
chart-draw = Draw here, from left to right
chart-pending = “Let it happen” draws here
chart-point = Your prediction at { $time } s
lens-name = The end-point under the law { $law }, magnified
lens-closest = closest point
lens-reference = reference point
lens-straight = straight link
transport-back = Back to now
transport-back_hint = Shows the present again. Key: End, on the handle
transport-go_on_hint = Discards what came after. Key: G

## The course as a static site: assets/web, app/exports/site

symbol-lambda = signed distance from the path
symbol-xi_1 = signed distance across the path
symbol-theta = place of the closest point on the path
symbol-theta_r = place of the clock's point on the path
symbol-e = tracking error: from the clock's point to the end-point
symbol-d = distance from the path
symbol-y = position of the end-point
symbol-sigma = the path
symbol-N = unit normal of the path
symbol-T = unit tangent of the path
symbol-F = force on the end-point
symbol-q_1 = angle of link 1
symbol-q_2 = angle of link 2
symbol-delta = angle at the elbow
symbol-rho = distance of the end-point from the base
symbol-K_1 = spring across the path, or to the clock's point
symbol-K_2 = damper that belongs to K1
symbol-K_3 = integral: it adds up the error over time
symbol-K_4 = spring along the path
symbol-K_5 = damper along the path: it keeps the wanted speed
site-symbols = Symbols on this page
site-title = OnPath: path following is not trajectory tracking
site-intro = Two robots draw the same path. One follows a timetable, the other a curve: see what happens when they are held back. In the course you predict, try, see and understand; everything runs in this page.
lecture-notes = Notes
lecture-open = A lecture of 20 minutes, with notes
site-lab = Try it
site-skip = To the text
site-only_lab = Only in the lab: { $what }.
site-run_only_lab = This run can be played only in the lab. The picture shows it.
site-task_only_lab = This task can be done only in the lab, which has what its solution needs.
site-link_only_lab = only in the lab
site-picture = What happens, { $quantity } [{ $unit }] over { $seconds } s. The largest values: { $peaks }.
site-answers = Answers
site-hint = Hint { $number }
site-recipe = Hint { $number }: the recipe (the task then counts as shown, not as solved)
site-why = Why did this work? Find a reason, then open
site-progress = Your progress
site-kept = Your progress is kept in this browser only. Save it as a file to go on elsewhere.
site-save = Save as a file
site-read = Read a file
site-forget = Delete
site-forget_sure = Delete all progress that is kept in this browser?
site-forgotten = Deleted.
site-read_done = Read.
site-no_progress = This file contains no progress in this course.
site-not_kept = This browser keeps nothing for this page. Your progress lasts until you close it.
site-skipped = You skipped the prediction. You can still make it here.
site-draw_first = Draw in the chart with the mouse or a finger, from left to right.
site-draw_keys = With keys: Tab goes to its points; the left and right arrows choose one, and the up and down arrows move it.
site-commit_short = Commit
site-skip_short = Skip
site-again = The curves of this run are not kept: let it happen again to see them.
site-no_platform = No learning platform was found around this page. Your progress is kept in this browser only.
site-refused = The learning platform did not take your progress: { $reason }. What is not kept is lost when you close this page.
site-no_room = The learning platform has no room for more of your progress: what you do now is lost when you close this page.
site-cut = The learning platform keeps at most { $most } characters of a lesson: of your longest texts, only the beginning. Keep a copy if you need them whole.
site-review = The learning platform opened this lesson for review: nothing of what you do now is kept.
site-sketch = Board to draw on: { $quantity } [{ $unit }] from 0 to { $seconds } s. With a mouse or a finger, from left to right; or with keys, by its points.
site-done = { $done } of { $all } steps seen, { $tasks } tasks passed
site-next_lesson = Next lesson: { $title }
site-end = The end of this lesson
site-features = What these pages do not have
site-features_text = These pages have no path editor, no law of your own, no other robot or law in the same step, no plots but that of the distance, no wall, no start beside the path, no identification, no class, no concept test and no CSV. Where a lesson uses one of these, it says so. The lab has them.
site-control-gains = all gains and realism
site-control-plots = the other plots
site-control-past = looking back
site-control-robot = the choice of the robot
site-control-laws = the choice of the law
site-control-identify = identification
site-why-identify = it needs a record of every millisecond, and statistics of the estimates
site-control-wall = the wall
site-control-sign = signing with the robots
site-why-sign = the page has no place to write on
site-control-path = the choice of the path

## Robots from files

robot_file-at = { $file }, line { $line }, { $element }: { $reason }
robot_file-at_line = { $file }, line { $line }: { $reason }
robot_file-absent = { $file }: there is no such file
robot_file-unreadable = { $file } cannot be read: { $reason }
robot_file-size = { $file } is larger than { $most }
robot_file-elements = more than { $most } elements, or more than { $deepest } nested in each other
robot_file-doctype = a document type is not accepted, because it can define entities: delete it
robot_file-xml = this is not XML: { $reason }
robot_file-root = a robot's file begins with <robot> (URDF) or <mujoco> (MJCF)
robot_file-xacro = this is a xacro file: give it a name that ends with .xacro, and install xacro: pip install "onpath[xacro]"
robot_file-without = { $what } is missing
robot_file-numbers = { $field } { $value }: expected { $count ->
    [one] a number
   *[other] { $count } numbers
 }
robot_file-large = { $field } { $value }: expected finite numbers up to 1e9
robot_file-no_link = there is no link { $name }
robot_file-two_parents = the link { $name } is already the child of the joint { $other }
robot_file-loop = the links form a loop: only trees of links can be simulated
robot_file-apart = no joint leads here from { $name }: all links of a robot must be connected
robot_file-twice = the name is already used in line { $line }
robot_file-many = more than { $most } of them
robot_file-type = unknown type { $type }
robot_file-outside = { $value } is outside the limits from { $low } to { $high }
robot_file-mass = the mass { $value } is negative
robot_file-negative = { $field } is negative
robot_file-limits = the lower limit { $low } is above the upper limit { $high }
robot_file-axis = an axis needs a direction
robot_file-no_joints = no joint of this file moves: it is one rigid body, such as a drone without an arm, and has nothing that could follow a path
robot_file-hand = all that moves in this file are fingers: it is a hand or a gripper. Load the arm that carries it, or name a finger's end with --tip (in Python, tip=…)
robot_file-still_tip = the tip does not move: no joint on the way to it does
robot_file-no_tip = there is no link { $tip }: there are { $names }
robot_file-no_joint = there is no joint { $joint }: there are { $names }
robot_file-pose = { $joint }: { $value } is not a position
robot_file-pose_outside = { $joint }: { $value } is not between its limits { $low } and { $high }
robot_file-armature = an armature of { $value } kg m²: expected 0 to { $most }
robot_file-no_pose = the tip cannot move in all directions from any pose: its joints turn it about one point, or about parallel axes. Name another link with --tip (in Python, tip=…)
robot_file-no_pose_package = the tip cannot move in all directions from any pose: its joints turn it about one point, or about parallel axes. Perhaps it is at the far end of its link, but the mesh that would show it needs a package that is missing: { $lines }. Or name another link with --tip (in Python, tip=…)
robot_file-singular = the tip cannot move in all directions from this pose: give another one with --pose (in Python, pose=…)
robot_file-circle = circles of up to { $circle } mm can be followed, but paths need { $least } mm: give another pose with --pose, or another link with --tip (in Python, pose=… and tip=…)
robot_file-single = only one joint moves the tip, as with a wheel, a rotor or a gripper: this is no arm or leg, which has at least two. Where the file has one, name its end with --tip (in Python, tip=…)
robot_file-two_across = two joints move the tip, and not in a plane, as with a camera's mount: it cannot follow a path. Where the file has an arm or leg, name its end with --tip (in Python, tip=…)
robot_file-guessed_pose = the file says nothing of a pose: one is chosen in which the tip moves easily in all directions
robot_file-guessed_pose_floor = the file says nothing of a pose: one is chosen in which the tip moves easily in all directions. Joints are below the floor, because there is no good pose above it
robot_file-guessed_pose_ahead = the file says nothing of a pose: one is chosen in which the tip moves easily in all directions. It is behind the base, because there is no good pose in front of it
robot_file-guessed_pose_floor_ahead = the file says nothing of a pose: one is chosen in which the tip moves easily in all directions. Joints are below the floor and the tip is behind the base, because there is no other good pose
robot_file-guessed_efforts = the file does not say what the motors can give: they are unlimited
robot_file-guessed_effort = the file does not say what the motors of { $joints } can give: they are unlimited
robot_file-guessed_armature = with the masses in the file, friction would stop a joint within a fraction of a millisecond, or a joint moves nothing that is heavy: an inertia of the motors of { $armature } kg m² is added
robot_file-massless = what the joint { $joint } moves has no mass or inertia: add an armature with --armature (in Python, armature=…)
robot_file-mujoco = an MJCF file needs MuJoCo: pip install "onpath[mujoco]"
robot_file-mjcf = MuJoCo cannot read { $file }: { $reason }
robot_file-mujoco_slow = MuJoCo was ended while it read { $file }: it took more than { $seconds } s
robot_file-mujoco_ended = MuJoCo has ended while it read { $file }: it crashed, or needed too much memory
robot_file-mujoco_warns = MuJoCo warns: { $reason }
robot_file-same_name = { $name } is the name of another robot
robot_file-absent_robot = this set-up is for the robot { $name }, which comes from a file: start the lab with { $line }, and with the options that it was started with there
robot_file-and_more = { $names } and { $more } more
robot_file-still = joints without travel between their limits stay still: { $names }
robot_file-not_drawn = not drawn, because there is no such .stl, .obj, .dae (URDF) or .msh (MJCF) file of up to 20 MB in the robot's folder or package, or it has no size: { $names }
robot_file-guessed_package = meshes are in the package { $package }, which is not known
robot_file-guessed_mass = the file states no masses of some bodies: they are taken for solids of { $density } kg/m³, together { $mass } kg: { $names }
robot_file-guessed_mass_without = the file states no masses of some bodies, and a package that reads their meshes is not installed: they are taken for solids of { $density } kg/m³, together { $mass } kg: { $names }
robot_file-guessed_inertia = the file states masses, but no inertia of them: they are taken for solids: { $names }
robot_file-repaired = no body can have the inertia that the file states, because a principal moment exceeds the sum of the others; the nearest one is taken: { $names }
robot_file-mass_stated = a mass of { $mass } kg is less than what the file states for some bodies, { $stated } kg: give more with --mass (in Python, mass=…)
robot_file-density_range = a density of { $value } kg/m³: expected more than 0, up to { $most }
robot_file-mass_range = a mass of { $value } kg: expected more than 0, up to { $most }
robot_file-shape = a shape needs a size, and a mesh a file
robot_file-no_xacro = { $file } is a xacro file, which needs xacro: pip install "onpath[xacro]"
robot_file-xacro_ended = xacro was ended while it expanded { $file }: it took too long, or needed too much memory
robot_file-xacro_refused = xacro cannot expand { $file }: { $reason }
robot_file-xacro_package = { $file } needs the package { $package }, which is neither around the file nor given: { $line }
robot_file-xacro_argument = { $file } asks for an argument, and gives it no value: write <xacro:arg name="{ $name }" default="…"/> below <robot>, with the value that you want
robot_file-xacro_ran = { $file } is a program: xacro has run its expressions, in a process with limits
robot_file-include = { $file } cannot be included: it is not an .xml file in the folder or package of the robot (--package NAME=FOLDER; in Python, packages=…), or it is included twice
robot_file-guessed_tip = the file does not say which link is the tip: { $tip } is taken
robot_file-guessed_end = the file has no link at the end of { $tip }, whose origin only the joints before it move: its far end is the tip, at { $place } m in its frame. A link there, with a fixed joint, would say so
robot_file-unread_end = the file has no link at the end of { $tip }, and a package that reads its mesh is not installed: the tip stays at its origin, which only the joints before it move
robot_file-guessed_free = floating, planar and ball joints stay where they are: { $names }
robot_file-guessed_mimic = joints that follow another one stay where they are: { $names }
robot_file-guessed_many = at most 8 joints can move on the way to the tip; these stay where they are: { $names }
robot_file-guessed_off = joints off the way to the tip stay where they are: { $names }
robot_file-guessed_limits = joints for which the file states no limits, or both as 0, are taken to have none: { $names }
robot_file-mesh_unreadable = the mesh { $mesh } is left out: { $reason }
robot_file-refused = <{ $element }> is not read, because it can read other files, run code or make many elements of one: leave it out, or load the file in MuJoCo and save it as plain elements
robot_file-unknown = there is no such element in <{ $parent }>
robot_file-meshes = the meshes have more than { $most }
robot_file-left_out = left out: { $parts }

## The arena (app/exports/arena_page.py)

arena-title = The arena
arena-made = OnPath · { $done ->
        [one] 1 trial
       *[other] { $done } trials
    } of { $planned } · { $command }
arena-about = How well does a control law keep a robot on its path when something is in the way? Each table has one robot, a row for each law, and a column for each thing that is measured, which is explained below the tables.
arena-same = Every law goes through the same trials: the same robot, path, obstruction and condition, the same gains, the same model, motors and torque limit, and the same random numbers. The torque limit is 1.5 times what undisturbed path following needs on that path, with weak motors 0.9 times, and for a robot from a file never more than the file states, of which it is given in %. Each law uses those of the gains K1 to K5 that its formula has, and its own. Trials and own gains are listed below.
arena-rows = Most laws have two rows, which differ in what happens when a motor would need more than its torque limit. “Cut”: the torque stays at the limit. “Across first”: a remedy that is no part of any law gives up acceleration along the path before it gives up any across it. A law that commands torques itself can only be cut.
arena-numbers = Each cell has the worst value over all trials that give one and, in small type, the median over them. The worst value is a link to its run. The number in the circle is the rank in this measure among the rows of the same robot, from 1, the best; equal values share a rank. A law with a run that was stopped ranks behind all laws without one. There is no total: what matters is yours to say.
arena-settings = The same for all laws: wanted speed { $speed } rad/s, so that a lap takes { $lap } s; { $gains }; control at { $rate } Hz, unless a trial says otherwise.
arena-gains = own gains: { $gains }
arena-measures = What is measured
arena-force_N = force to leave the path
arena-force_N_text = A hand goes along with the end-point and pulls it across the path, with a force that grows by 2 N each second up to 10 N. This is the force when the end-point is first 5 mm from the path. “Not up to 10 N”: it never is; 0.00: it was before the hand pulled. What happens under a stronger pull does not count. A law with a large force yields little; for a robot that is meant to yield, that is no advantage.
arena-distance_m = distance
arena-distance_m_text = The largest distance of the end-point from the path during a trial, in all trials except the pull.
arena-delay_s = delay
arena-delay_s_text = How late the end-point is at the end of a trial, compared with a point that runs at the wanted speed all the time; negative: early. Ranked without the sign. A law without a clock is late by about as long as it was held, on purpose. Laps are counted by the closest point: an end-point that cuts across the inside may lose a lap, and is late by the time of one.
arena-energy_J = energy given to the hand
arena-energy_J_text = The largest work that the end-point has done on what pulls or holds it, or on the wall, at any time, in the trials with one of them. A person who holds the robot feels it as a push.
arena-overshoot_m = overshoot after release
arena-overshoot_m_text = How far the end-point leaves the path again after a pull, a hold or a wall has let it go, counted from the moment at which it is within 5 mm of the path and comes no nearer. “Not back”: it is not within 5 mm until the end of the trial.
arena-stops = stops
arena-stops_text = Runs that were ended because the motion diverged or the law failed, of all runs of this row. They have no other numbers. The first three are linked.
arena-of = { $stops } of { $runs }
arena-law = law
arena-limit = at the torque limit
arena-cut = cut
arena-remedy = across first
arena-torques = cut, commands torques
arena-median = median { $value }
arena-better_larger = larger is better
arena-better_smaller = smaller is better
arena-better_near_zero = near 0 is better
arena-rank = rank { $rank } of { $of }
arena-never = not up to 10 N
arena-not_back = not back
arena-own = yours
arena-trials = { $count ->
        [one] 1 trial
       *[other] { $count } trials
    }
arena-obstructions = The trials
arena-trial = trial
arena-robot = robot
arena-path = path
arena-obstruction = obstruction
arena-condition = condition
arena-torque_limit = torque limit
arena-sized = { $path }, { $width } × { $height } mm
arena-pull = a pull across that grows, from { $begin } s on
arena-brake = held along the path, { $begin } to { $end } s
arena-hand = a hand that pulls to a place { $away } mm from the path, { $begin } to { $end } s
arena-wall = a wall across the path, { $begin } to { $end } s
arena-weak = weak motors
arena-exact = exact model and sensors
arena-payload = a payload of { $payload } kg that no law knows
arena-noise = sensor noise of { $sensor_noise } rad, encoders with { $encoder_counts } counts per turn
arena-slow = control at { $control_rate } Hz
arena-runs = The runs behind the numbers
arena-run = { $obstruction }; { $path }, { $condition } (trial { $number }, { $robot })
arena-picture = Left: the distance from the path over time; shaded: while the obstruction acts; dashed: 5 mm. Right: the path, grey, and the line that the end-point draws.
arena-scale = Left: 0 to { $lasts } s and 0 to { $most } mm.
arena-recorded = The point moves as it was recorded.
arena-figure = Try this law on this robot: a live figure
arena-repeat = The same run:
arena-stopped = stopped at { $time } s: { $reason }
arena-laws = The laws
arena-interrupted = interrupted: { $html } has the trials that all laws have finished
arena-nothing = interrupted before all laws had finished a trial
arena-first = first table, after { $seconds } s
arena-written = written: { $html } and { $csv }

## What stands around the stage: head, search, help, sheets

question-yes = Yes
question-no = No
panel-handle = Controls: to half or all of the height
head-more = More
search-title = Search
search-hint = A setting, robot, law, path, lesson or key
search-found = What was found
search-none = Nothing found. Try another word.
search-kind_open = Open
search-kind_robot = Robot
search-kind_law = Law
search-kind_path = Path
search-kind_lesson = Lesson
search-kind_key = Key
search-of_robots = All robots with their pictures
search-of_laws = What each law does, and how to type one of your own
search-of_compare = The same obstruction for several laws, with curves and a table
search-of_keep = Codes, share, export, table, picture, recording, record of lessons
search-of_lessons = All lessons and routes, and how far you are
search-of_help = What is what, keys, glossary
search-of_log = What a real arm has logged, over the plots
search-of_file = A path from a table of points, a drawing or G-code
search-of_class = Your nickname, what is stored of you, join or leave
search-of_teach = The teacher's page, with the teacher's key
search-of_display = Language, look: light or dark, large type, speech, sound
look-title = Look
look-system = as the system
look-light = light
look-dark = dark
help-point = Show what is what
help-keys = All keys
help-own_keys = A control that has the focus gets its own keys first: the arrows on a slider, the space bar on a button.
keys-time = Time
keys-hand = Hand
keys-path = Path
keys-wall = Wall
keys-rest = Other
aid-hold = Hold both
aid-hold_means = stops both tips. The tracker is torn off by its clock; the follower waits.
aid-pull = Drag a tip
aid-pull_means = to pull the robot off its path, with the mouse or a finger.
aid-bend = Drag a grey ball
aid-bend_means = to bend the path while the robots run.
aid-aim = Ring or dot
aid-aim_means = what the law aims at: a ring runs by the clock, a dot is the closest point of the path.
aid-lens = Lens
aid-lens_means = the tip, enlarged by the number below it.
aid-chart = Plot
aid-chart_means = how far each tip is from its path. Drag it to look back in time.
aid-view = Right button, two fingers
aid-view_means = turn the view. “Reset view” resets it.
aid-search = Search
aid-search_means = finds every setting, robot, law, path, lesson and key.
laws-own_heading = A law of your own
lesson-done = done
lesson-begun = begun
lesson-begin_here = Begin here
lesson-go_on_here = Go on here
route-routes = Routes for an occasion
robots-differs_five_bar = two motors, rigid links
robots-differs_cart_pendulum = a pendulum without a motor
robots-differs_hovercraft = no push sideways
robots-differs_flexible = its last link bends
robots-differs_planar_arm = one motor more than needed
robots-differs_rod_gantry = a rod without a motor
robots-differs_seven_axes = seven motors, holds a posture
robots-differs_spatial_arm = leaves the plane
robots-differs_two_link_arm = shoulder and elbow, against gravity
keep-sharing = Share
keep-coming_back = Come back later
keep-record = Record of my lessons
compare-laws = Laws
compare-computing = Computing: { $done } of { $all } laws
compare-put = Put on the stage
compare-put_left = Put on the left
compare-put_right = Put on the right
compare-on_left = on the left
compare-on_right = on the right
compare-on_both = on both
compare-time = time [s]
compare-curves = Distance from the path over time, where each law is worst. Grey: the obstruction acts.
setup-draw = Draw
setup-file = File…
setup-file_hint = A drawing (SVG), points (CSV) or G-code. All its lines are drawn, one after the other.

## What is guessed about a robot from a file

guess-mark = guessed: { $kinds }
guess-next = { $listed }, { $other }
guess-last = { $listed } and { $other }
guess-mass = mass
guess-inertia = inertia
guess-effort = motor limits
guess-tip = end-point
guess-pose = pose
guess-told = { $what } ({ $line } settles it)

## Robots that are named by a folder or a package

robot_file-empty_folder = { $folder } has no robot's file ({ $endings })
robot_file-which_file = { $folder } has { $count } robots' files. Name one: { $lines }
robot_file-not_fetched = robot_descriptions cannot fetch { $name }: { $reason }
robot_file-no_description = { $name } of robot_descriptions has no file that can be read

## Tips that a robot's file suggests

robots-tip = end-point { $tip }
robots-show_tips = Show other end-points
robots-show_tips_hint = Balls in the scene, with names: the links that the robot's file suggests as its end. Press one, and the robot is built with it.
robots-build = It is built when you choose it, which takes some seconds.
robots-no_such_tip = no file of this lab suggests that end-point
robots-waiting = Another robot is being built; yours comes next …
robots-reading = Reading { $file } with the end-point { $tip } …
robots-shapes = Reading the meshes for the end-point { $tip } …
robots-not_built = { $file } with the end-point { $tip }: { $reason }. The robot stays as it was
robots-not_read = it could not be read ({ $reason })

## A plant elsewhere, in the place of a robot

plant-name = Plant
plant-simulated = Simulated
plant-law = Law, plant
plant-law_simulated = Law, simulated
plant-start = START
plant-stop = STOP
plant-stop_hint = Ends it now. Key: Esc
plant-start_hint = Starts the controller. The arm moves as soon as its program measures.
plant-at_fault = Torque after the end
plant-zero = none
plant-hold = the last one
plant-damp = against the motion
plant-off = Nothing has been started.
plant-starting = The controller is being made …
plant-waiting = It waits for the plant at { $address }. The arm moves as soon as its program measures.
plant-running = It runs.
plant-ended = It has ended: { $cause }.
plant-sends = The plant still sends; its torque now: { $torque }. START is possible when its program has ended.
plant-late = at most { $late } ms late in the last second, { $latest } ms since the start
plant-safety = No safety function. Around a real arm there must be a stop that cuts the power, and its maker's limits; keep out of its reach.
plant-watching = This page watches; another one drives.
plant-stopped = somebody has pressed STOP
plant-page_lost = the page that drives it is lost, or in the background
plant-stood_still = the lab has stood still for a second
plant-failed = { $reason }
plant-cannot = With a real arm this cannot be done.
