### Was die Oberfläche auf Deutsch sagt, für Project Fluent (https://projectfluent.org/).
###
### Dieselben Nachrichten mit denselben Argumenten wie in en.ftl; dazu die Namen von Parametern,
### Bahnen, Robotern und Regelgesetzen, deren Englisch in models/ steht.

## Lektionen

robot-follower = Bahnfolger
robot-tracker = Nachläufer
robot-under_law = { $robot } ({ $law })

quantity-distance = Abstand von der Bahn
quantity-lag = Abstand zum laufenden Punkt
quantity-speed = Geschwindigkeit längs der Bahn
quantity-rate = Rate des Bahnparameters
quantity-place = Ort auf der Bahn
quantity-across = Abweichung quer zur Bahn
quantity-across_rate = Geschwindigkeit quer zur Bahn
quantity-torque = Drehmoment
quantity-force = Kraft
quantity-deflection = Durchbiegung
quantity-energy = Energie im Balken

stat-max = größter Wert, { $quantity }
stat-min = kleinster Wert, { $quantity }
stat-mean = Mittelwert, { $quantity }
stat-rms = Effektivwert, { $quantity }
stat-settling = Einschwingzeit ({ $quantity })
stat-overshoot = Überschwingen ({ $quantity })
stat-final = { $quantity } jetzt

during-always = { "" }
during-held = , solange festgehalten
during-pulled = , solange gezogen
during-free = , solange frei
during-released = , nach dem Loslassen

check-below = unter { $limit } { $unit }
check-above = über { $limit } { $unit }
check-and = { $first } und { $second }
check-broken = { " " }(verfehlt bei { $time } s)
check-bound = { $robot }: { $stat }{ $during }: { $value } { $unit }; verlangt: { $wanted }
check-compare = { $larger }: { $stat }{ $during } ist das { $ratio }-fache des anderen; verlangt: das { $wanted }-fache oder mehr
check-better = { $robot }: { $stat }{ $during }: { $value }; im Durchgang davor: { $before }; verlangt: weniger
check-seconds = { " " }({ $have } von { $need } s)
check-nothing = { $robot }: { $stat }{ $during }: noch nichts{ $seconds }; verlangt: { $wanted }
check-event = { $event }: { $have } von { $need }
check-since = { $event }, und danach nichts hiervon: { $events }
check-order = in dieser Reihenfolge: { $events }
check-setting = { $name } ist { $value }; verlangt: { $wanted }
check-equals = { $value }
check-path = Bahn
check-length = Länge der Bahn in mm
check-robot = Roboter
check-start = Start
check-wall = Wand
check-own_path = eigene
check-only = Außer dem, worum es geht, ist verändert: { $others }. Stelle es zurück oder öffne den Schritt noch einmal
check-once = { $robot }: bei { $setting } = { $equals } ist { $stat }{ $during } { $least } s lang { $value } { $unit }; verlangt: { $wanted }
check-stopped = { $robot } ist stehen geblieben: Drücke Zurücksetzen und versuche es noch einmal

event-hold = festhalten
event-let_go = loslassen
event-pull = ziehen
event-release = ziehen beenden
event-set = { $detail } ändern
event-set_any = einen Parameter ändern
event-path = die Bahn { $detail } wählen
event-path_any = die Bahn ändern
event-reset = zurücksetzen
event-identify = identifizieren
event-diverged = ein Roboter bleibt stehen
event-robot = den Roboter { $detail } wählen
event-robot_any = einen anderen Roboter wählen
event-law = das Regelgesetz { $detail } wählen
event-law_any = ein anderes Regelgesetz wählen

equations-title =
    { $count ->
        [one] Gleichung ({ $first }) des Artikels, Zeichen für Zeichen
       *[other] Gleichungen ({ $first }) bis ({ $last }) des Artikels, Zeichen für Zeichen
    }
equations-formula = Artikel
equations-here = hier
equations-place = wo
equations-lesson = Lektion { $number }
equations-figure = Bild { $number }
lesson-lessons = Lektionen
lesson-choose = Lektionen: vorhersagen, probieren, sehen, verstehen
lesson-minutes = { $minutes } min
lesson-warm_up = Aus einer früheren Lektion, zählt nicht
lesson-optional = freiwillig
lesson-branch = zu deiner Antwort
lesson-past_optional = Die freiwilligen Schritte überspringen, zu Schritt { $step }
lesson-past_all = Die freiwilligen Schritte überspringen und abschließen
lesson-aims = Wozu, und was du brauchst
lesson-needs = Du brauchst:
lesson-goals = Danach kannst du:
lesson-close = Lektion verlassen
lesson-close_hint = ins freie Labor; die Lektion merkt sich, wo du bist
lesson-back = Zurück
lesson-wait = Die Klasse wartet hier, bis die Lehrkraft weitergeht.
lesson-out_of_pace = Die Lehrkraft lässt die Klasse vorerst nur in die Schritte { $first } bis { $last }.
lesson-next = Weiter
lesson-skip = Vorhersage überspringen
lesson-finish = Fertig
lesson-locked = Lege dich erst auf eine Vorhersage fest, oder überspringe sie.
lesson-nothing_to_predict = hier gibt es nichts vorherzusagen
lesson-no_such_option = diese Antwort gibt es nicht
lesson-no_number = das ist keine Zahl
lesson-no_such_task = diese Aufgabe gibt es in diesem Schritt nicht
lesson-no_more_hints = zu dieser Aufgabe gibt es keinen weiteren Hinweis
lesson-again = Schritt von vorn
lesson-again_hint = Roboter und alle Einstellungen wie zu Beginn dieses Schritts
lesson-play = Geschehen lassen
lesson-skip_run = Lauf überspringen
lesson-replay = Noch einmal geschehen lassen
lesson-playing = Es läuft: Sieh zu.
lesson-happened = Der Lauf ist zu Ende. Was geschah, steht im Text.
lesson-step = Schritt { $step } von { $steps }
lesson-commit = Auf diese Vorhersage festlegen
lesson-committed = Du hast dich festgelegt. Sieh jetzt, was geschieht.
lesson-drawn = Zeichne noch einmal, oder lege dich fest.
lesson-yours = du
lesson-right = Richtig.
lesson-not_quite = Nicht ganz.
sketch-looked_for = Worauf es ankommt
sketch-own = in deiner Kurve
sketch-run = im Lauf
sketch-seen = ja
sketch-unseen = nein
lesson-second_title = Zweiter Versuch
lesson-second_try = diese Frage ist schon beantwortet; der zweite Versuch fragt etwas anderes
lesson-once_more = Überleg noch einmal und antworte ein zweites Mal: Dann wird die richtige Antwort gezeigt.
lesson-discuss = Such jemanden, der anders geantwortet hat, besprecht die Frage, und antworte dann noch einmal.
lesson-discuss_curve = Deine erste Kurve bleibt im Diagramm stehen. Such jemanden, der eine andere gezeichnet hat, besprecht sie, und zeichne dann noch einmal.
lesson-discuss_letter = Du hast { $letter } geantwortet. Such jemanden, der anders geantwortet hat, besprecht die Frage, und antworte dann noch einmal.
lesson-second = Nach der Diskussion:
lesson-drawn_again = Du hast die Kurve noch einmal gezeichnet
lesson-unknown = Du hast das beantwortet, als die Lektion noch anders war. Die Antworten haben sich seitdem geändert; welche du gewählt hast, lässt sich nicht mehr sagen.
lesson-skipped = Du hast die Vorhersage übersprungen.
lesson-predict_before = Gehe erst zurück und triff die Vorhersage, oder überspringe sie.
lesson-passed = Geschafft
lesson-passed_best = Geschafft; dein bester Wert: { $best } { $unit }
lesson-hint = Hinweis (noch { $left })
lesson-recipe = Letzter Hinweis: das Rezept (die Aufgabe gilt dann als gezeigt, nicht als gelöst)
lesson-controls = Einstellungen
lesson-all_controls = Alle Einstellungen
lesson-language = Sprache
lesson-presenting = Vortrag: große Schrift
lesson-english = nur auf Englisch

kind-play = Frei probieren
kind-predict = Vorhersagen
kind-run = Sehen
kind-explain = Verstehen
kind-task = Aufgabe
kind-quiz = Frage

language-de = Deutsch

## Antworten neben einer Vorhersage, und Antworten, die eine Zahl oder ein Text sind

answer-how_sure = Wie sicher bist du? (freiwillig)
answer-sure = Wie sicher du warst:
answer-why = Deine Begründung:
answer-because = Warum? (freiwillig)
answer-not_said = keine Angabe
answer-number = Deine Antwort:
answer-words = Du hast geschrieben:
answer-model = So könnte man antworten:
answer-type_number = Deine Zahl
answer-type_unit = Deine Zahl [{ $unit }]
answer-type_words = Deine Antwort, mit eigenen Worten
answer-type_formula = Deine Formel in { $names }
answer-check = Prüfen
answer-price = Beim ersten Mal richtig zählt ganz, beim zweiten halb.
answer-before = Und die Antwort auf die Frage davor:
answer-price_followed = Gleich richtig zählt ganz. Nach einer falschen Antwort wird etwas anderes gefragt, das zählt halb.
answer-price_second = Richtig zählt halb.
answer-keep = Antwort behalten
answer-sending = Wird gesendet …
answer-sent = Gesendet.
answer-carried = Richtig, mit deinem eigenen Wert von vorhin.
answer-line = Die Zeile lautet:
formula-refused = Ab dem { $place }. Zeichen nicht verstanden: { $reason }.
formula-missing = hier fehlt eine Zahl, ein Name oder eine Klammer
formula-between = vor dieser Zahl fehlt ein Zeichen wie + oder *
formula-bracket = eine Klammer fehlt oder ist zu viel
formula-exponent = ein Exponent ist eine ganze Zahl von 0 bis { $most }; eine Wurzel ist sqrt(…)
formula-unclear = das lässt sich auf zwei Arten lesen; mit Klammern ist es klar
formula-function = schreibe { $name }(…), mit Klammern
formula-unknown = das bedeutet hier nichts; es gibt { $names }
formula-long = höchstens { $most } Zeichen
sure-guessing = geraten
sure-fairly = ziemlich sicher
sure-certain = ganz sicher

## Das Ende einer Lektion

end-title = Was du vorhergesagt hast, und was geschah
end-route = Das Ende der Route
end-right =
    { $all ->
        [one] { $part } von 1 Auswahlfrage richtig
       *[other] { $part } von { $all } Auswahlfragen richtig
    }
end-drawn =
    { $all ->
        [one] { $part } von 1 Kurve gezeichnet
       *[other] { $part } von { $all } Kurven gezeichnet
    }
end-tasks =
    { $all ->
        [one] { $part } von 1 Aufgabe geschafft
       *[other] { $part } von { $all } Aufgaben geschafft
    }
end-takeaway = Was du mitnimmst
end-next = Lektion { $lesson } öffnen
end-record = Mein Bericht

## Behalten und teilen

keep-title = Behalten und teilen
keep-yours = Der Code deines Labors. Notiere ihn: Damit machst du anderswo weiter.
keep-until =
    { $days ->
        [one] Dein Labor wird gelöscht, wenn es einen Tag lang nicht benutzt wurde.
       *[other] Dein Labor wird gelöscht, wenn es { $days } Tage lang nicht benutzt wurde.
    }
keep-other = Anderer Code
keep-other_hint = Der Code eines Labors, das du anderswo begonnen hast
keep-go = In jenem Labor weitermachen
keep-share = Diesen Aufbau teilen
keep-shared = Schicke diese Adresse oder nur den Code: Beide enthalten Roboter, Bahn, Verstärkungen und Realismus.
keep-paste = Geteilter Code
keep-paste_hint = Füge einen Code ein, den dir jemand geschickt hat
keep-use = Das Labor danach aufbauen
keep-report = Meine Lektionen als Bericht (HTML)
keep-failed = Dein Labor kann gerade nicht gespeichert werden. Du kannst weitermachen: Lass diese Seite offen, bis sie sagt, dass es wieder gespeichert ist.
keep-too_large = Dein Labor ist zu groß geworden, um gespeichert zu werden. Was zuletzt gespeichert wurde, bleibt erhalten; was du ab jetzt tust, geht verloren, wenn du diese Seite schließt.
keep-again = Dein Labor ist wieder gespeichert.
keep-anew = Die Datei, in der Labore gespeichert werden, wurde gelöscht oder ersetzt. Dein Labor wird in einer neuen gespeichert.
keep-with_code = Den Code meines Labors in den Bericht schreiben
keep-with_code_means = Wer den Code hat, kann dein Labor öffnen, sehen, was du getan hast, und es ändern. Lass ihn weg, wenn du den Bericht abgibst.

## Die Klasse

full-text =
    { $places ->
        [one] Der einzige Platz ist besetzt.
       *[other] Alle { $places } Plätze sind besetzt.
    } Lass diese Seite offen: Sie geht von selbst weiter, sobald einer frei ist.
full-network = Alle { $places } Plätze für ein Netz sind besetzt; die übrigen werden für andere Netze freigehalten. Lass diese Seite offen: Sie geht von selbst weiter, sobald einer frei ist.
full-before =
    { $count ->
        [0] Niemand wartet länger.
        [one] Eine Seite wartet länger.
       *[other] { $count } Seiten warten länger.
    }

test-title_before = Vor dem Kurs: { $title }
test-title_after = Nach dem Kurs: { $title }
test-open_name = Test öffnen: { $title }
test-hand_in = Abgeben
test-handed_in = abgegeben
test-answered = { $part } von { $all } beantwortet. Bis du abgibst, kannst du deine Antworten ändern.
test-locked = Während eines Tests steht das Labor still.
test-over = Der Test ist schon abgegeben.
test-thanks = Abgegeben. Danke.
test-later = Was richtig ist, und warum, erfährst du, wenn du den Test nach dem Kurs abgegeben hast.
test-score = { $part } von { $all } richtig
test-before = Vor dem Kurs
test-after = Nach dem Kurs
test-chosen_before = Vorher:
test-chosen_after = Nachher:
test-none = keine Antwort
test-students = { $count ->
        [0] Noch hat niemand beide Tests abgegeben.
        [one] 1 Person hat beide Tests abgegeben.
       *[other] { $count } Personen haben beide Tests abgegeben.
    }
test-means = Richtige Antworten: vorher { $before }, nachher { $after }.
test-share = { $value } % ({ $low }–{ $high })
test-interval = { $value } ({ $low } bis { $high })
test-fewest = Was sie dazugelernt hat, steht hier ab { $count } Personen: Bei weniger entscheidet der Zufall.
test-gain = Normierter Lernzuwachs: { $gain }
test-gain_means = Diesen Anteil dessen, was die Klasse vorher nicht wusste, hat sie gelernt: (nachher − vorher) / (100 % − vorher). Jede Hälfte der Klasse hatte zuerst eine andere Form, und gemittelt wird über beide Formen; deshalb macht es nichts, wenn eine davon leichter ist.
test-gain_none = Normierter Lernzuwachs: nicht definiert, denn vorher waren alle Antworten richtig.
test-waiting = { $part } von { $all } haben den Test vor dem Kurs abgegeben, { $after } den danach.
test-number = Nr.
test-right_before = Vorher richtig
test-right_after = Nachher richtig
test-aims = Was die falschen Antworten sagen
test-form = Form { $form }
test-alone = Konzepttest: Jede Person antwortet für sich allein.
test-treated = Mehr darüber: Lektion { $lesson }, Seite { $step }.
test-of_form = Form { $form }: { $count } Personen
test-of_questions = Die Fragen: { $count } Personen
test-difficulty = Richtig
test-discrimination = Trennschärfe
test-intervals = In Klammern: das Intervall zu 95 %, bei Anteilen nach Wilson, sonst durch wiederholtes Ziehen aus der Klasse (Bootstrap). Die Trennschärfe ist die Korrelation zwischen einer richtigen Antwort und der Zahl der richtigen Antworten auf die anderen Fragen, unter denen, die die Form vor dem Kurs, und unter denen, die sie danach hatten. Nahe bei 0 unterscheidet die Frage niemanden; unter 0 führt sie gerade die in die Irre, die mehr wissen.
class-title = Klasse
class-code = Klassencode
class-code_hint = Er steht auf der Leinwand
class-nickname = Spitzname
class-nickname_hint = Höchstens 24 Zeichen; es muss nicht dein richtiger Name sein
class-stored = Dein Labor speichert deine Vorhersagen und gezeichneten Kurven, deine Antworten, auch die in eigenen Worten, deine Aufgaben und Verstärkungen und wann du zuletzt etwas getan hast. Deine Lehrkraft sieht das alles unter deinem Spitznamen. Der Spitzname wird gelöscht, wenn du die Klasse verlässt oder sie endet, das Übrige, { $days ->
        [0] wenn der Server endet
        [one] wenn es einen Tag lang nicht benutzt wurde
       *[other] wenn es { $days } Tage lang nicht benutzt wurde
    }. Deine Lehrkraft kann alles sofort löschen.
class-kept_until = Die Klasse selbst mit ihren Spitznamen wird { $days ->
        [one] einen Tag
       *[other] { $days } Tage
    } nach der letzten Änderung gelöscht: wenn sie ab heute niemand mehr benutzt, am { $date }.
class-date = %d.%m.%Y
class-keep_for = Die Klasse nach ihrer letzten Änderung löschen
class-days =
    { $days ->
        [one] nach einem Tag
       *[other] nach { $days } Tagen
    }
class-asks = Studierende fragen nach
class-asks_nothing = nichts, was sie identifiziert
class-asks_email = ihrer E-Mail-Adresse
class-asks_idnumber = ihrer Matrikelnummer
class-asks_username = ihrem Anmeldenamen
class-grades = Die Ergebnisse haben dann auch ein Blatt Grades mit Punkten fürs Mitmachen in jeder Lektion: Es zählt, dass geantwortet wurde, nicht, dass es stimmt. In Moodle kommt es unter Bewertungen, Import, Aus einer Tabelle einfügen hinein. Moodle nimmt alle Zeilen oder keine: Es nennt die erste Angabe, die es nicht kennt. Studierende finden das Feld auf der Karte unter ihrem Spitznamen, auf der bis dahin „In die Liste eintragen“ steht.
class-id_email = E-Mail-Adresse (deine Lehrkraft sieht sie)
class-id_idnumber = Matrikelnummer (deine Lehrkraft sieht sie)
class-id_username = Anmeldename (deine Lehrkraft sieht ihn)
class-id_hint = Für eine Liste, wer mitgemacht hat; du kannst das Feld leer lassen. Wird mit deinem Spitznamen gelöscht.
class-id_known = Deine Lehrkraft hat das. Eine neue Angabe ersetzt es, ein leeres Feld nimmt es zurück.
class-id_send = Senden
class-sign = In die Liste eintragen
class-word = Ein eigenes Wort
class-word_hint = Für Untersuchungen, wenn du magst: Gib vor und nach dem Kurs dasselbe Wort ein, auf irgendeinem Gerät, dann gehören deine beiden Tests zusammen, auch nach Monaten. Das Wort zeigt nichts und löscht nichts. Aufbewahrt wird nur ein Hash davon. Mindestens 6 Zeichen; nimm kein Passwort.
class-word_send = Verknüpfen
class-word_own = Dein Wort ist gespeichert. Ein anderes ersetzt es, ein leeres Feld entfernt es.
class-word_shared = Jemand anders in dieser Klasse hat dasselbe Wort, und eure Tests geraten durcheinander. Nimm ein anderes.
class-forget_me = Alles löschen, was von mir gespeichert ist
class-forget_me_sure = Dein Labor mit deinen Vorhersagen, gezeichneten Kurven, Antworten und Aufgaben und deinen Platz in der Klasse löschen? Das lässt sich nicht rückgängig machen. Diese Seite beginnt mit einem neuen Labor.
class-privacy = Datenschutzerklärung
class-join = Der Klasse beitreten
class-leave = Die Klasse verlassen
class-elsewhere = Die Seite dieser Klasse öffnen
class-member = Du bist als { $name } in der Klasse. Die Lehrkraft sieht, wo du in den Lektionen bist, und dein Labor.
class-teacher = Lehrkraft…
class-key = Schlüssel der Lehrkraft
class-key_hint = Der Server sagt beim Start, wo er steht
class-teach = Seite der Lehrkraft öffnen
class-stop_teaching = Seite der Lehrkraft schließen
class-of = Klasse { $code }
class-what_stored = Was wird von dir gespeichert?
class-then = Öffnet deine Lehrkraft einen Schritt, so kommt er von selbst auf diese Seite. Bis dahin gehört das Labor dir.
class-gone = Dieses Labor ist jetzt in keiner Klasse: Die Klasse ist zu Ende, deine Lehrkraft hat dich herausgenommen, oder es ist ein anderes Labor als vorher. Es geht hier ohne Klasse weiter.
class-too_long = Ein Spitzname hat höchstens { $most } Zeichen.
class-frozen = Die Lehrkraft hat alle Labore angehalten: Schau nach vorn. Deines geht danach von hier aus weiter.
class-setup = Die Lehrkraft hat dein Labor aufgebaut.
class-setup_in_step = Die Lehrkraft hat dein Labor aufgebaut. „Schritt von vorn“ bringt den Aufbau dieses Schritts zurück.
class-step = Die Lehrkraft hat diesen Schritt für dich geöffnet.
class-step_elsewhere = Die Lehrkraft hat diesen Schritt für dich geöffnet. Die Lektion, in der du warst, steht unter „Lektionen“, wie du sie verlassen hast.
class-step_again = Die Lehrkraft stellt diese Frage noch einmal. Besprich sie zuerst mit jemandem neben dir.
class-ask_again = Nach einer Diskussion noch einmal fragen
class-play = Die Vorführung hier zeigen
class-put_back = Meinen eigenen Aufbau zurückholen
class-show_answers = Antworten zeigen
class-lead = Für die ganze Klasse
class-first = Erste Antwort
class-second = Nach der Diskussion
class-unknown = { $count } haben eine frühere Fassung der Frage beantwortet; was sie gewählt haben, lässt sich nicht mehr sagen.
class-open_address = Öffne diese Adresse und gib einen Spitznamen ein:
class-only_here = Nur dieser Rechner kann sie öffnen. Für andere starte mit --host 0.0.0.0.
class-qr = QR-Code dieser Adresse
class-qr_remote = QR-Code der Adresse für das Handy der Lehrkraft
class-wall = Ansicht für den Beamer öffnen, ohne Knöpfe und ohne Namen
class-let_in = Handy mit der Nummer { $number } hereinlassen
class-throw_out = Handy { $number } abmelden
class-peek = Antworten nur auf diesem Bildschirm
class-timer = In einer Minute beenden
class-cell_here = da
class-cell_answered = geantwortet
class-cell_right = richtig
class-cell_changed = geändert
class-dots_here =
    { $more ->
        [0] { $count } da
       *[other] { $count } noch nicht
    }
class-dots_answered =
    { $more ->
        [0] { $count } geantwortet
       *[other] { $count } anders geantwortet
    }
class-dots_right = { $count } richtig
class-dots_changed = { $count } geändert
class-proposal_explain = { $percent } % liegen richtig: erklären?
class-proposal_discuss = { $percent } % liegen richtig: diskutieren lassen und noch einmal fragen?
class-proposal_go_on = { $percent } % liegen richtig: weitergehen?
class-remote = Vom Handy aus unterrichten: dort diese Adresse öffnen
remote-title = Lehrkraft
remote-ask = Auf der Seite der Lehrkraft das Handy hereinlassen, das diese Nummer zeigt:
remote-full = Zu viele Handys fragen gerade. Warte zwei Minuten.
remote-plain = Diese Seite ist nicht verschlüsselt: Wer im selben Netz ist, könnte mitlesen und sich als Lehrkraft ausgeben.
class-count = { $count } in der Klasse
class-name = Spitzname
class-lesson = Lektion
class-step_head = Schritt
class-tasks = Aufgaben
class-state = Zustand
class-here = da
class-away = weg
class-idle = seit { $minutes } min untätig
class-free = Freies Labor
class-nobody = Noch ist niemand beigetreten.
class-follow = Zusehen bei
class-own_lab = Mein eigenes Labor
class-rename_hint = Höchstens 24 Zeichen; die Person sieht ihn auch
class-remove = Aus der Klasse nehmen
class-removed = Herausgenommen. Das Labor geht ohne die Klasse weiter und kann wieder beitreten.
class-delete = Diese Person löschen
class-delete_sure = { $name } aus der Klasse löschen, und das Labor mit allem, was davon gespeichert ist: Vorhersagen, gezeichnete Kurven, Antworten, Aufgaben? Das lässt sich nicht rückgängig machen. Eine offene Seite beginnt mit einem neuen Labor.
class-deleted = Gelöscht.
class-following = Das ist das Labor von { $name }. Du kannst nur zusehen.
class-hidden = Der Tab dieser Person ist verdeckt: Das Labor wartet.
class-absent = Diese Person ist nicht verbunden: Das Labor wartet.
class-freeze = Alle Labore anhalten
class-unfreeze = Alle Labore weiterlaufen lassen
class-push_setup = Meinen Aufbau an alle senden
class-push_code = Diesen Code an alle senden
class-push_step = Diesen Schritt bei allen öffnen
class-back = Zurück für alle
class-next_step = Weiter für alle: { $step }
class-sent =
    { $count ->
        [0] Noch ist niemand da.
        [one] An 1 Person gesendet.
       *[other] An { $count } Personen gesendet.
    } Wer später beitritt, bekommt es.
class-standing_setup = Wer beitritt, bekommt den Aufbau, den du zuletzt gesendet hast.
class-standing_step = Wer beitritt, kommt zu dem Schritt, den du zuletzt geöffnet hast: { $lesson }, Schritt { $step }.
class-push_end = Nicht mehr an alle senden, die beitreten
class-predictions = Vorhersagen
class-truth = Wirklichkeit zeigen
class-no_prediction = In diesem Schritt wird nichts gefragt.
class-no_truth = Was wirklich geschieht, ist noch nicht bekannt: Es muss erst in einem Labor geschehen sein.
class-predicted = Vorhersagen
class-median = gestrichelt: der Median, um ihn herum die mittlere Hälfte der Vorhersagen
class-given =
    { $away ->
        [0] { $given } von { $here } Anwesenden haben geantwortet.
       *[other] { $given } von { $here } Anwesenden haben geantwortet ({ $away } sind weg).
    }
class-moves = Von der ersten Antwort (Zeilen) zur zweiten (Spalten)
class-other_shape = etwas anderes
class-drew = { $count }-mal { $name } (etwa Nummer { $example }).
class-drew_other = { $count }-mal etwas anderes (etwa Nummer { $example }).
class-skipped = { $count } haben übersprungen.
class-late =
    { $count ->
        [one] 1 Antwort kam nach dem Ende der Abstimmung und zählt nicht.
       *[other] { $count } Antworten kamen nach dem Ende der Abstimmung und zählen nicht.
    }
class-closes = Die Abstimmung endet in { $seconds } s.
class-closed = Die Abstimmung ist beendet.
class-came_late = Die Abstimmung ist beendet: Deine Antwort wird aufgehoben, zählt aber nicht.
class-close_vote = Abstimmung beenden
class-open_vote = Abstimmung wieder öffnen
class-vote_is_open = Die Klasse stimmt noch ab. Es geht weiter, wenn deine Lehrkraft die Abstimmung beendet.
class-other_numbers = andere Zahlen
class-is_it_you = { $name } ist gerade weg. Bist du das? Dann kann deine Lehrkraft dir deinen Platz zurückgeben, mit allem, was du dort getan hast.
class-ask_place = Das bin ich: die Lehrkraft fragen
class-place_asked = Deine Lehrkraft ist gefragt, ob du { $name } bist.
class-claim = { $name } sagt: Ich bin { $former } und war kurz weg.
class-give_place = Ja, den Platz zurückgeben
class-keep_apart = Nein, das ist jemand anderes
class-set_aside = Alle beiseitelassen, die weg sind ({ $count })
class-set_aside_told =
    { $count ->
        [one] 1 Person bleibt beiseite, bis sie zurückkommt.
       *[other] { $count } Personen bleiben beiseite, bis sie zurückkommen.
    }
class-record = Ergebnisse
class-record_text = Eine Zeile für jede Antwort, mit ihrer Zeit und ob sie zu spät kam, und für jede Aufgabe und jede offene Frage der begonnenen Lektionen. Die Tabelle enthält Spitznamen: Behandle sie als personenbezogene Daten.
class-export = Ergebnisse der Klasse (XLSX)
class-end = Die Klasse beenden
class-end_sure = Die Klasse beenden? Spitznamen und Ergebnisse der Klasse werden gelöscht; die Labore gehen ohne Klasse weiter. Sichere die Ergebnisse zuerst.
class-ended = Die Klasse ist zu Ende. { $count ->
        [0] Niemand war dabei.
        [one] 1 Person war dabei.
       *[other] { $count } Personen waren dabei.
    } Adresse und Code bleiben dieselben.
class-forget = Die Klasse und ihre Labore löschen
class-forget_sure = Die Labore aller Personen dieser Klasse löschen, mit allem, was davon gespeichert ist, und die Klasse beenden? Das lässt sich nicht rückgängig machen. Offene Seiten beginnen mit einem neuen Labor.
class-forgotten =
    { $count ->
        [0] Kein Labor wurde gelöscht.
        [one] 1 Labor wurde gelöscht.
       *[other] { $count } Labore wurden gelöscht.
    }
class-picked = Gezeigte Skizzen
class-picked_hint = Nummern wie 2, 5; leer für alle
class-whereabouts = { $ended } am Ende der Lektion, { $elsewhere } woanders
pace-title = Tempo
pace-first = Von Schritt
pace-last = Bis Schritt
pace-keep = Die Klasse in diesen Schritten halten
pace-end = Die Klasse überallhin lassen
pace-none = Die Klasse darf überallhin.
pace-kept = Die Klasse darf in die Schritte { $first } bis { $last } von { $lesson }.
gains-title = Verstärkungen
gains-axes = Achsen
gains-pair = { $across } und { $up }
gains-scatter = Die Verstärkungen aller
gains-border = Grenze zwischen Schwingen (darunter) und Kriechen (darüber)
gains-students =
    { $count ->
        [one] 1 Person
       *[other] { $count } Personen
    }

## Die beiden Prüfstände

side-left = links
side-right = rechts
side-title = { $law }, { $side }

law-trajectory_tracking-label = Nachlaufregelung
law-trajectory_tracking-text = Folgt einem Punkt, der nach der Uhr auf der Kurve läuft, was der Roboter auch tut.
law-trajectory_tracking-good = Sie ist pünktlich: Auch nach einem Hindernis ist sie wieder dort, wo die Uhr sie haben will.
law-trajectory_tracking-limits = Festgehalten wartet sie nicht: Losgelassen verlässt sie die Kurve, um aufzuholen.
law-trajectory_tracking-objection = Wer sie einsetzt, würde den Fahrplan nach dem Loslassen neu planen, damit nichts aufzuholen ist.
law-path_following-label = Bahnfolgeregelung
law-path_following-text = Bleibt auf der Kurve und regelt das Tempo auf ihr; eine Uhr hat sie nicht.
law-path_following-good = Festgehalten und losgelassen bleibt sie auf der Kurve und geht ohne Hast mit dem gewünschten Tempo weiter. Mit K5 = 0 ist sie eine virtuelle Führung (guiding virtual fixture): Nur die Hand bewegt den Roboter auf der Kurve.
law-path_following-limits = Verlorene Zeit bleibt verloren: Losgelassen ist sie um so viel zu spät, wie sie festgehalten wurde.
law-path_following-objection = Ihre Autoren begrenzen weder das Integral noch den Abstand, aus dem (16) zurückführt; hier geschieht beides.
law-contouring-label = Konturregelung
law-contouring-text = Folgt der Uhr, aber steif quer zur Kurve und weich längs der Kurve.
law-contouring-good = Sie ist pünktlich und gibt längs der Kurve nach, während sie quer zu ihr steif ist, solange ihr Fehler klein ist.
law-contouring-limits = Ihre Achsen sind die ihres Bezugspunkts, gedacht für Fehler, die gegen den Krümmungsradius klein sind: Festgehalten ist sie sofort neben ihrer Kurve, und ein Festhalten, das andere Gesetze aushalten, kann sie in einer Viertelsekunde zum Anhalten bringen.
law-contouring-objection = Ihre Autoren würden ihren Fehler klein halten, mit einer langsameren Uhr oder einer steiferen Maschine, und das Verhältnis zur Maschine passend wählen.
law-event_based-label = Ereignisbasiert
law-event_based-text = Folgt mit der gewünschten Rate dem nächsten Punkt, als wäre er der Punkt einer Uhr.
law-event_based-good = Sie erreicht das gewünschte Tempo schneller als alle anderen ohne Fahrplan.
law-event_based-limits = Festgehalten verlangt sie weiter die Beschleunigung zu einem Tempo, das sie nicht hat, und verlässt die Kurve.
law-event_based-objection = Ihre Autoren ließen einen Planer das Tempo längs der Bahn wählen, das hier vorgegeben ist.
law-set_point-label = Festwertregelung
law-set_point-text = Geht geradewegs zum Ziel und weiß nichts von der Kurve dazwischen.
law-set_point-good = Sie erreicht das Ziel und bleibt dort, wo auch immer sie beginnt.
law-set_point-limits = Unterwegs verlässt sie die Kurve, weil sie den geraden Weg nimmt.
law-set_point-objection = Niemand schlägt sie für das Befolgen einer Bahn vor: Sie zeigt, was die Bahn beiträgt.
law-velocity_field-label = Geschwindigkeitsfeld
law-velocity_field-text = Eine Strömung längs der Kurve trägt den Roboter und gibt mit richtigem Modell und genauen Sensoren einer Hand nicht mehr Energie, als sie vorrätig hat.
law-velocity_field-good = Wird es von der Kurve gezogen, gibt es der Hand weniger Energie als jedes Gesetz mit einem Fahrplan.
law-velocity_field-limits = Es regelt seine Energie und nicht sein Tempo: Zurückgezogen und losgelassen läuft es schneller weiter, als es soll.
law-velocity_field-objection = Seine Autoren begrenzen kein Drehmoment, weil ihr Schwungrad in stetiger Zeit nie leer wird.
law-virtual_constraint-label = Perle auf einem Draht
law-virtual_constraint-text = Hält die Spitze durch eine virtuelle Zwangsbedingung auf der Kurve und lässt sie längs der Kurve in Ruhe.
law-virtual_constraint-good = Sie hält die Kurve ein und überlässt das Tempo dem, der sie schiebt.
law-virtual_constraint-limits = Sie bewegt sich nicht von selbst: In Ruhe bleibt sie, wo sie ist.
law-virtual_constraint-objection = Ihre Autoren stabilisieren Orbits von Robotern mit weniger Motoren als Gelenken, und das ist eine Perle auf einem Draht nicht.
law-waiting_clock-label = Wartende Uhr
law-waiting_clock-text = Folgt einem Punkt, dessen Uhr langsamer geht, wenn der Roboter zurückbleibt.
law-waiting_clock-good = Festgehalten und losgelassen bleibt sie der Kurve so nah wie die Bahnfolgeregelung.
law-waiting_clock-limits = Eine Hand, die den Roboter wegzieht, stört auch seine Uhr: Danach eilt er erst, um seinen Punkt wieder einzuholen.
law-waiting_clock-objection = Die Ljapunow-Funktion ihrer Autoren enthält auch die Geschwindigkeit, wie hier die der Manövrierregelung.
law-disturbance_observer-label = Störbeobachter
law-disturbance_observer-text = Bahnfolge, die die Kraft quer zur Kurve schätzt und ihr bis zu einer Grenze entgegenwirkt.
law-disturbance_observer-good = Nach langem Ziehen ist er früher wieder auf der Kurve als die Bahnfolge, weil er die Kraft sofort vergisst.
law-disturbance_observer-limits = Eine Kraft jenseits seiner Grenze bringt ihn ab wie eine Feder, und mit verrauschten Sensoren zittern seine Drehmomente stärker als die der Bahnfolge.
law-disturbance_observer-objection = Seine Autoren würden auch längs der Bahn beobachten und ein Filter höherer Ordnung nehmen.
law-maneuvering-label = Manövrierregelung
law-maneuvering-text = Folgt einem Punkt, der sich so auf der Kurve bewegt, dass eine Ljapunow-Funktion fällt.
law-maneuvering-good = Nach einem Start oder einem Ruck nimmt sie das gewünschte Tempo ohne die Hast einer wartenden Uhr auf.
law-maneuvering-limits = Festgehalten steuert sie weiter das gewünschte Tempo vor und verlässt die Kurve weiter als eine wartende Uhr.
law-maneuvering-objection = Ihre Autoren würden den Gradienten filtern und Robustheit gegen Störungen beweisen, wovon hier nichts genutzt wird.
law-orbital_stabilization-label = Orbitale Stabilisierung
law-orbital_stabilization-text = Geht auf der Kurve so hin und her, dass ein Pendel ohne Motor weiterschwingt.
law-orbital_stabilization-good = Sie hält ein Pendel ohne Motor aufrecht, auf einem Orbit, zu dem es nach einem Stoß zurückkehrt, und bleibt auf der Kurve.
law-orbital_stabilization-limits = Sie geht nie herum, und ein aufrechtes Pendel fällt, wo die Kurve für seinen Ausschlag zu kurz oder zu steil ist.
law-orbital_stabilization-objection = Ihre Autoren behandeln jeden Roboter, dem ein Motor fehlt, und dieses Gesetz ist für einen Wagen geschrieben.
law-time_optimal_following-label = Zeitoptimale Bahnfolge
law-time_optimal_following-text = Bahnfolge mit dem Tempo, das an jeder Stelle so schnell ist, wie die Grenzen der Drehmomente zulassen.
law-time_optimal_following-good = Sie geht so schnell, wie die Grenzen der Drehmomente zulassen, und bleibt festgehalten und losgelassen nahe an der Kurve.
law-time_optimal_following-limits = Sie ist so gut wie ihr Modell: Mit einer Nutzlast, die sie nicht kennt, erreichen ihre Drehmomente die Grenzen.
law-time_optimal_following-objection = Ein Tempo, das allein vom Ort abhängt, nutzt kein Drehmoment, das eine Störung übrig lässt.
law-time_optimal_tracking-label = Zeitoptimale Nachlaufregelung
law-time_optimal_tracking-text = Folgt einem Punkt, der so schnell auf der Kurve läuft, wie die Grenzen der Drehmomente zulassen.
law-time_optimal_tracking-good = Innerhalb ihrer Drehmomente ist sie überall auf der Kurve, mit dem schnellsten Tempo, das sie zulassen.
law-time_optimal_tracking-limits = Festgehalten verlässt sie die Kurve wie jedes Gesetz mit einer Uhr, und was sie dann verlangt, liegt jenseits ihrer Grenzen.
law-time_optimal_tracking-objection = Wer so plant, würde nach einer Behinderung von dort aus neu planen, wo der Roboter ist.
law-own-label = Eigenes Gesetz
law-own-xi = Abstand von der Bahn, positiv links von ihr
law-own-dxi = Änderungsrate von xi
law-own-theta = Parameter des nächsten Punktes der Bahn
law-own-dtheta = Änderungsrate von theta: das Tempo längs der Bahn
law-own-e1 = Fehler: vom Punkt, der nach der Uhr läuft, zur Spitze
law-own-de1 = Änderungsrate des Fehlers
law-own-y1 = Lage der Spitze
law-own-v1 = Geschwindigkeit der Spitze
law-own-t = Zeit, seit das Gesetz gewählt wurde
law-own-theta_r = Parameter des Punktes, der nach der Uhr läuft
law-own-speed = gewünschtes Tempo längs der Bahn
law-own-int_xi = Integral von xi; es steht, solange ein Drehmoment am Anschlag ist, und K3 int_xi ist begrenzt
law-own-K1 = die eingestellten Verstärkungen
law-own-xi2 = zweiter Abstand von der Bahn
law-own-dxi2 = Änderungsrate von xi2
law-own-int_xi2 = Integral von xi2
law-own-e3 = dritte Komponente des Fehlers
law-own-de3 = ihre Änderungsrate
law-own-y3 = dritte Koordinate der Spitze
law-own-v3 = dritte Komponente ihrer Geschwindigkeit

aim-theta = zielt auf den nächsten Bahnpunkt
aim-theta_ref = zielt auf seinen Sollpunkt

## Die Seite: was immer da ist

connect-no_webgl = Die Roboter werden nicht gezeichnet: Diesem Browser fehlt WebGL 2, oder es ist ausgeschaltet. Alles andere geht.
connect-course_link = Zum Kurs
connect-picture_lost = Das Bild der Roboter ging verloren; das Labor läuft weiter. Das Bild kommt von selbst zurück; wenn nicht, lade die Seite neu.
connect-opening = Die Verbindung zum Labor wird aufgebaut …
connect-building = Das Labor bereitet deine Seite vor. Wenn viele auf einmal kommen, dauert das etwas länger.
connect-loading = Das Bild der Roboter wird geladen. Alles andere geht schon.
connect-picture_back = Das Bild der Roboter wird wiederhergestellt. Alles andere läuft weiter.
connect-back = Das Labor war unterbrochen oder wurde neu gestartet. In ein paar Sekunden geht es für dich weiter.
connect-slow = Das Labor ist gerade langsam: Sein Rechner ist ausgelastet, oder die Verbindung ist schlecht. Nichts geht verloren.
connect-silent = Das Labor antwortet nicht. Läuft es noch? Diese Seite versucht weiter, es zu erreichen.
connect-blocked = Das Labor antwortet, aber seine Verbindung öffnet sich nicht. Vielleicht ist es voll, oder ein Proxy dazwischen leitet Websockets nicht weiter: assets/deploy/README.md zeigt, wie. Diese Seite versucht es weiter.
connect-offline = Dieses Gerät hat keine Verbindung zu einem Netz. Sobald es eine gibt, geht es von selbst weiter.
connect-lost = Die Verbindung zum Labor ist abgebrochen. Was du siehst, steht still; die Seite versucht weiter, das Labor zu erreichen.
connect-forbidden = Dieses Labor lässt Seiten von { $origin } nicht zu. Öffne es unter seiner eigenen Adresse, oder bitte den, der es betreibt, diese zuzulassen (--origin).
connect-refused = Das Labor weist diese Seite immer wieder ab. Lade die Seite neu; wenn das nicht hilft, sag dem, der das Labor betreibt, dass sein Proxy eine Seite vielleicht zu mehreren Prozessen leitet.
connect-version = Das Labor hat jetzt eine andere Version. Lade die Seite neu; dein Labor hat alles behalten.
page-scene = Zwei Roboter, die einer Bahn folgen, von vorn gesehen. Was sie tun, wird laufend angesagt; die Tasten des Labors stehen unter „Hilfe und Tasten“.

spoken-running = Läuft.
spoken-paused = Pause.
spoken-held = Festgehalten.
spoken-on_path = Beide auf der Bahn.

display-title = Sprache, Anzeige
display-speaks = Ansagen, was geschieht (für Bildschirmleser)
display-sounds = Abstand als Ton: linker Roboter im linken Ohr, rechter im rechten
breakdown-slowly = Langsam zeigen
breakdown-end = Nicht weiter zeigen
breakdown-reset = Mit denselben Einstellungen zurücksetzen
breakdown-earlier = Zurücksetzen mit { $changes }
summary-clock = Zeit { $time } Sekunden. Bahn: { $path }.
summary-robot = { $robot }: { $now } Millimeter von der Bahn, höchstens { $most }, { $speed } Millimeter je Sekunde die Bahn entlang.

code-copy = Kopieren
code-copied = Kopiert

readout-paused = t = { $time } s, angehalten
readout-running = t = { $time } s, läuft mit { $speed }×

caption-torn_off = weggerissen: bis zu { $mm } mm
caption-held = festgehalten: bis zu { $mm } mm
caption-waits = wartet: bis zu { $mm } mm
caption-pulled = gezogen: { $mm } mm
caption-pulled_far = gezogen: { $mm } mm, zieht geradewegs zurück
caption-pulled_bounded = gezogen: { $mm } mm, I-Anteil gesättigt
caption-returns = weit ab, kehrt geradewegs zurück: { $mm } mm
caption-off_bounded = neben der Bahn: { $mm } mm, I-Anteil gesättigt
caption-chases = eilt seinem Punkt nach: { $mm } mm
caption-off = neben der Bahn: { $mm } mm
caption-stopped = angehalten
caption-at_end = am Ende: Zurücksetzen drücken
caption-spoken = { $robot }: { $caption }.

stage-building = { $robot }: das Bild wird aufgebaut …
stage-paused = Die Zeit steht still
stage-past = Rückblick auf { $time } s

invite-hold = Zwei gleiche Roboter folgen einer Bahn. Was geschieht, wenn ihnen etwas im Weg steht? Drücke auf „Beide festhalten“.
invite-let_go = Der Ring ◯ des Nachläufers läuft nach der Uhr weiter und reißt ihn von der Bahn. Der Punkt ● des Bahnfolgers wartet mit ihm. Lass jetzt beide los.
invite-pull = Sei nun selbst das Hindernis: Drücke mit der Maus oder dem Finger auf die Spitze eines Roboters und halte still. Eine Hand wirkt auf beide.
invite-pulled = Hältst du still, wartet der Bahnfolger an deiner Hand, und den Nachläufer zieht seine Uhr fort. Ziehst du nach außen, verlassen beide die Bahn: Eine solche Hand hält sie nicht auf.
invite-bend = Verbiege die Bahn: Ziehe an einem ihrer grauen Punkte.
invite-lesson = Was geschieht, während ein Roboter zwei Sekunden lang festgehalten wird? Sag es in Lektion 1 voraus, und sieh dann nach.
invite-lesson_button = Lektion 1 öffnen
invite-skip = Einführung überspringen

scene-draw = Zeichne die Bahn in einem Zug
scene-force = Kraft { $force } N
scene-true_scale = maßstäblich
scene-larger = Durchbiegung { $factor }× gezeichnet

robots-choose = Wähle einen Roboter
robots-illustrative = Die Zahlen der mitgelieferten Roboter sind Beispiele und gehören zu keinem bestimmten Gerät.

laws-left = Linker Roboter
laws-right = Rechter Roboter
laws-hint = Der Roboter bewegt sich von dort, wo er ist, unter diesem Gesetz weiter
laws-own = Eigenes Gesetz…
laws-own_left = Eigenes Gesetz des linken Roboters
laws-own_right = Eigenes Gesetz des rechten Roboters
laws-own_hint = Die Eingabetaste setzt das Gesetz ein; mit der Umschalttaste beginnt sie eine neue Zeile
laws-about = Über die Regelgesetze
laws-bounds = Das Integral jedes Gesetzes ist begrenzt: K3 verschiebt das Gleichgewicht um höchstens { $reach } mm und in einer Biegung um ihren halben Radius, sodass keine Hand es aufziehen kann. Gesetze, die der Bahn über ihren nächsten Punkt folgen, kehren dort, wo auf diesen Punkt kein Verlass ist, allein mit K1 und K2 geradewegs zurück: ab dem halben Krümmungsradius auf der Innenseite, ganz ab vier Fünfteln, wo er oder die Richtung der Bahn sich von der Messung bis zum Drehmoment um 0,15 bis 0,3 rad mehr dreht als gewünscht, und 5 bis 20 mm jenseits eines offenen Endes.
laws-source = Quelle: { $source }
laws-own_text = Eine Zeile across = … gibt die Beschleunigung quer zur Bahn in m/s² vor, eine Zeile along = … die längs der Bahn in rad/s²; oder u1 = …, u2 = … geben die Drehmomente aller Motoren in N m vor.
laws-own_space = Bei einem Roboter, der sich im Raum bewegt, ist across2 = … die Beschleunigung längs der zweiten Normalen.
laws-own_language = Eine Formel hat Zahlen, die Namen unten, + - * /, ** mit einem Exponenten von 0 bis { $most }, { $functions } und a if xi > 0 else b („a, wenn xi > 0, sonst b“); Bedingungen verbindet man mit and, or und not.
laws-name = Name
laws-meaning = Bedeutung
laws-unit = Einheit

run-hold_both = Beide festhalten
run-hold = Festhalten
run-let_both_go = Beide loslassen
run-let_go = Loslassen
run-hold_hint = Hält die Spitzen fest, bis du noch einmal drückst. Wer länger drückt, hält nur so lange fest. Taste: H
run-run = Laufen lassen
run-pause = Pause
run-run_hint = Hält die simulierte Zeit an oder lässt sie weiterlaufen. Taste: Leertaste
run-step = Schritt
run-reset = Zurücksetzen
run-view = Ansicht zurück
run-view_hint = Zeigt die Roboter wieder von vorn
run-rate = Zeit läuft mit

controls-help = Hilfe und Tasten

## Die Wand und der Start

wall-title = Wand
wall-forces = Kraft auf die Wand

start-title = Start
start-show = Zeigen, um ihn zu ziehen
start-show_hint = Eine grüne Kugel in der Szene: Dort beginnt der nächste Lauf; ihr Pfeil ist die Geschwindigkeit. Solange sie zu sehen ist, lassen sich auch die Glieder eines Roboters aus einer Datei ziehen: Jedes dreht dort sein Gelenk
start-reset = Dort beginnen
start-reset_hint = Beginnt von neuem, an diesem Start
start-default = Auf der Bahn
start-default_hint = Setzt den Start wieder auf die Bahn, in Ruhe

## Die Bahn

design-path = Bahn
design-path_hint = Beide Roboter folgen ihr. Ziehe an ihren Punkten im Bild, um sie zu verbiegen.
design-own = eine eigene Bahn
design-refused = { $path } (wird abgelehnt)
design-ambiguous = { $path } (kreuzt sich)
design-draw_hint = Zeichne dann mit der Maus oder dem Finger einen Strich um einen der Roboter. Endet er nahe an seinem Anfang, ist die Bahn geschlossen; sonst heben die Roboter den Stift und fangen wieder von vorn an. Noch einmal drücken beendet das Zeichnen.
log-title = Messung eines Arms
log-hint = Was ein wirklicher Arm aufgezeichnet hat, höchstens { $most } MB: eine Tabelle (CSV) mit Zeiten, Gelenkwinkeln und Drehmomenten oder Arrays aus NumPy oder MATLAB. Die Messung wird über die Verläufe gezeichnet, vom Beginn jedes Laufs an. Der Arm muss von der Art sein, die hier simuliert wird.
log-choose = Messung eines Arms …
log-file = Messung wählen
log-none = keine
log-which = welche Spalte?
log-column = Spalte für { $name }
log-unit = Einheit von { $name }
log-unit_hint = Eine Einheit, oder ihre Größe in SI-Einheiten, etwa 0.085 für einen Strom in Ampere
log-instead = Es ist die Messung eines Arms
log-drawn = { $file } wird über die Verläufe gezeichnet, vom Beginn jedes Laufs an: „Zurücksetzen“ beginnt einen.
log-shown = { $file } wird über die Verläufe gezeichnet, vom Beginn jedes Laufs an.
log-shown_in_part = Was { $file } unter dem ersten Gesetz enthält, wird über die Verläufe gezeichnet, vom Beginn jedes Laufs an.
log-after_lesson = { $file } wird über die Verläufe gezeichnet, sobald keine Lektion offen ist.
design-files = Aus einer Datei
design-size = Größe [mm]
design-size_hint = Die längere Seite der Bahn; 0 lässt die Längen, wie sie in der Datei sind
design-radius = Radius der Ecken [mm]
design-radius_hint = Bögen mit diesem Radius ersetzen die Ecken; 0: Ecken werden nur so weit gerundet, wie es die Roboter brauchen
design-pace = Bis zu { $speed } mm/s entlang der Zeichnung, in Biegungen langsamer.
design-open = Offene Bahn
design-open_hint = Das Ende wird nicht mit dem Anfang verbunden; sonst wie in der Datei, und Punkte werden verbunden
design-upload = Datei wählen
design-upload_hint = Punkte (CSV), eine Zeichnung (SVG) oder G-Code, höchstens { $most } MB; man kann sie auch auf die Seite ziehen oder einfügen. Alle Linien werden nacheinander gezeichnet; wer nur eine will, drückt darauf.
design-lines = Die Linien der Datei
design-parts = Linien
design-parts_hint = Welchen Linien der Datei gefolgt wird, etwa 1, 3; leer: allen. Ein Druck auf eine Linie im Bild nimmt sie hinzu oder wieder weg.
design-turn = Drehung [°]
design-turn_hint = Gegen den Uhrzeigersinn
design-right = Mitte, rechts [mm]
design-right_hint = Wo die Mitte der Bahn liegt, entlang der ersten Achse ihrer Ebene
design-up = Mitte, oben [mm]
design-up_hint = Wo die Mitte der Bahn liegt, entlang der zweiten Achse ihrer Ebene
design-chosen = { $file } wurde zuletzt gewählt. Änderungen wirken sofort darauf.
design-not_followed = Ihr kann nicht gefolgt werden: { $reasons }. Die Stellen sind auf der Bühne markiert; die Bahn bleibt, wie sie war.
design-larger = Größer: { $size } mm
design-smaller = Kleiner: { $size } mm
design-both = Größer, { $size } mm, und Ecken auf { $radius } mm gerundet
design-rounder = Ecken auf { $radius } mm runden
design-followed = Die Roboter folgen { $file }; „Rückgängig“ nimmt das zurück. Änderungen der Werte hier unten wirken sofort darauf.
design-reading = Die Datei wird gelesen.
design-undo = Rückgängig
design-undo_hint = Nimmt die letzte Änderung der Bahn zurück
design-redo = Wiederholen
design-redo_hint = Stellt die zurückgenommene Änderung wieder her
design-add = Einfügen
design-add_hint = Ein neuer Punkt der Bahn, hinter dem ausgewählten
design-remove = Entfernen
design-remove_hint = Nimmt den ausgewählten Punkt aus der Bahn
design-selected = Ausgewählt
design-no_point = keiner
design-coordinate = { $name } [mm]
design-coordinate_hint = Wo der ausgewählte Punkt in der Ebene der Bahn liegt
design-arrows = Pfeiltasten schieben den ausgewählten Punkt um 1 mm; N wählt den nächsten. Um einen Punkt zu ziehen, den die Spitze verdeckt, wähle ihn zuerst aus.
design-slanted_circle = Ellipse von (23)
design-rank = Rangtest (11) längs der Bahn: mindestens { $number } von 1.
design-zone = Singuläre Zone zeigen
design-zone_hint = Wo der Arm gestreckt oder gefaltet ist, Gl. (14)

## Verstärkungen und Realismus

gains-defaults = Auf Anfangswerte
gains-defaults_hint = Gibt dem Roboter und seinen Regelungen die üblichen Werte
gains-across = Quer
gains-along = Längs
gains-pulse = Prüfstoß
gains-pulse_hint = Zieht beide Spitzen eine Achtelsekunde lang quer zur Bahn und zeigt so, was die Verstärkungen bewirken
gains-rate = Abklingen [1/s]
gains-swing = Schwingen [rad/s]
gains-poles = Pole { $poles } 1/s
gains-poles_at = Pole { $poles } 1/s bei θ = { $place }°; sie ändern sich längs der Bahn
gains-identify = M und b identifizieren
gains-identify_hint = Schätzt M und b aus den letzten 3 s des rechten Roboters und setzt sie in das Modell beider Regler ein.

## Der elastische Balken

flexible-pull = Zugebene
flexible-pull_hint = Die Ebene durch die Spitze, in der die Maus an ihr zieht
flexible-beam = Balken und Regelstrecke
flexible-composite = Zusammengesetzte Regelung
flexible-computing = kritisches α: wird berechnet
flexible-none = kritisches α: keines bis 1
flexible-critical = kritisches α = { $critical }, hier und in Ruhe
flexible-critical_on_path = kritisches α = { $critical }, das kleinste auf dieser Bahn, in Ruhe
flexible-of_beam =
    { $modes ->
        [one] 1 Mode
       *[other] { $modes } Moden
    }, jede mit ζ = { $zeta }
flexible-unstable = Nulldynamik instabil
flexible-deflections = Durchbiegung: { $each }; { $scale }
flexible-deflection = { $robot } { $value } mm
flexible-drawn = { $factor }× gezeichnet

pull-path-s-plane = Bahnebene
pull-horizontal-plane = waagerechte Ebene

## Was auf Wunsch in der Szene gezeigt wird

show-labels = Namen, Achsen
show-labels_hint = Winkel q, Längen ℓ und die Achsen von y, wie in den Bildern 1 und 4 des Artikels
show-tube = Schlauch
show-tube_hint = Wo der nächste Punkt der Bahn eindeutig ist: Dort ist der virtuelle Ausgang definiert
show-grid = Netz längs und quer zur Bahn
show-grid_hint = Linien quer zur Bahn haben denselben nächsten Punkt, also dasselbe θ; Linien längs der Bahn denselben Abstand ξ.
show-rank = Wo die Gesetze definiert sind
show-rank_hint = Wie weit jeder Ort davon entfernt ist, dass der Rang verloren geht und die Regelgesetze nicht mehr definiert sind
show-errors = Beide Fehler
show-errors_hint = e (orange) führt zum Punkt des Fahrplans, dem Ring des linken Roboters; d (blau) führt zum nächsten Punkt der Bahn.
show-mass = Effektive Masse
show-mass_hint = Wie schwer sich die Spitze in jeder Richtung anfühlt: Der Radius wächst mit der Wurzel der Masse, und 6 cm stehen für 1 kg.
show-width = Bis { $width } mm neben der Bahn ist der nächste Punkt eindeutig.
show-width_none = Die Bahn ist gerade: Der nächste Punkt ist überall eindeutig.
show-steps = Linien alle { $xi } mm in ξ und alle { $theta }° in θ.
show-rank_scale = Kleinster Singulärwert von (∂h/∂q) g_v: Beschleunigung des Ausgangs je Drehmoment, in der Richtung, in der sie am kleinsten ist, in (m/s²)/(N m). Bei 0 geht der Rang verloren, Gl. (11).
show-rank_alpha = Mit α = { $alpha } und geradem Balken.

## Bilder über der Zeit: Namen in der Liste, dann Überschriften mit Einheiten

plots-menu = Verläufe
plots-menu_hint = Welche Größen gezeigt werden
plots-time = Zeit, Verläufe
plots-time_hint = Wie schnell die Zeit läuft, und welche Größen gezeigt werden
plots-theta_ref = Sollwert von θ

plot-phase = Phasenebene (ξ₁, ξ₂)
plot-phase_name = Phasenebene: ξ₂ über ξ₁ beider Roboter in den letzten 3 Sekunden. Der Ursprung ist die Bahn.
plot-distance = Abstand von der Bahn
plot-speed = Geschwindigkeit längs der Bahn
plot-torques = Drehmomente
plot-forces = Kräfte der Motoren
plot-mixed = Drehmomente und Kräfte der Motoren
plot-across = ξ₁ quer
plot-across_rate = ξ₂ Rate quer
plot-place = η₂¹ = θ Ort längs
plot-rate = η₂² = θ' Rate längs
plot-modes = η₁ Moden des Balkens
plot-deflection = Durchbiegung der Spitze
plot-energy = innere Energie
plot-force = Kraft

axis-distance = Abstand von der Bahn [mm]
axis-speed = Geschwindigkeit [mm/s]
axis-torques = Drehmoment [N m]
axis-forces = Kraft eines Motors [N]
axis-mixed = Drehmoment oder Kraft eines Motors [N m, N]
axis-across = ξ₁ [mm]
axis-across-space = ξ₁, ξ₃ [mm]
axis-across_rate = ξ₂ [mm/s]
axis-across_rate-space = ξ₂, ξ₄ [mm/s]
axis-across-level_set = ξ₁ = s(y) [mm²]
axis-across_rate-level_set = ξ₂ = s'(y) [mm²/s]
axis-place = η₂¹ = θ [rad]
axis-rate = η₂² = θ' [rad/s]
axis-modes = η₁: jede Mode, an der Spitze [mm]
axis-deflection = Durchbiegung [mm]
axis-energy = Energie im Balken [mJ]
axis-force = Kraft [N]

## Die letzte Minute, und Dateien

past-go_on = Von hier aus weiter
past-undo = Verworfenes zurückholen
past-undo_hint = Nimmt „Von hier aus weiter“ zurück und legt beiseite, was seither geschah. Taste: U

export-title = Exportieren
export-table = CSV, letzte 60 s
export-picture = Bild der Verläufe
export-lines = Bild beider Linien
export-film = Aufnahme (HTML), letzte 10 s
export-caught = Ein Ring: Hier wurde der Roboter festgehalten
export-making = { $name } entsteht …
export-busy = Eine Datei nach der anderen: Die zuletzt verlangte entsteht noch.
export-ready = { $name } ist fertig.
export-failed = { $name } ist misslungen.
export-nothing = Es gibt noch nichts zu exportieren: Lass es erst laufen.

## Der Vergleich der Regelungen

compare-title = Regelungen vergleichen
compare-text = Für alle derselbe Roboter, dieselbe Bahn, dasselbe Tempo und dieselben Verstärkungen, und ein Hindernis. Das gewünschte Tempo bleibt gleich. Gerechnet wird im Hintergrund, mit den jetzigen Einstellungen dieses Labors; es läuft weiter.
compare-obstruction = Hindernis
compare-run = Vergleichen
compare-count = Wähle ein bis { $most } Regelungen aus.
compare-law = Regelung
compare-distance = größter Abstand von der Bahn  [mm]
compare-delay = Verspätung am Ende  [s]
compare-force = größte Kraft  [N]
compare-stopped = angehalten
compare-stopped_text = „angehalten“: An mindestens einer Stelle ist die Bewegung divergiert, und die Simulation wurde beendet.
compare-picture = Größter Abstand von der Bahn über der Verspätung am Ende, für jede Regelung
residuals-torque = Drehmoment, gefiltert
residuals-left = nicht erklärt
compare-path = Ein Vergleich braucht eine geschlossene Bahn und ein Tempo ungleich 0: Wähle eine solche Bahn und den Auftrag Tempo.
obstruction-none = keines
obstruction-brake = 2 s festgehalten, an acht Stellen
obstruction-push_across = quer zur Bahn gezogen
obstruction-push_ahead = nach vorn gezogen
obstruction-push_back = zurückgezogen
obstruction-wall = eine Wand im Weg
obstruction-weak_motors = schwache Motoren
obstruction-weak_motors_cut = schwache Motoren, Momente abgeschnitten
obstruction-too_fast = doppeltes Tempo, begrenzte Motoren
obstruction-too_fast_cut = doppeltes Tempo, Momente abgeschnitten
obstruction-start_off_at_rest = Start neben der Bahn, in Ruhe
obstruction-start_off_moving = Start neben der Bahn, in Bewegung

## Das mitgenommene Bild

figure-history = { $robot }, Bahn: { $path }. Die letzten { $seconds } s
figure-xi_means = ξ: Abstand der Spitze von der Bahn, mit Vorzeichen; 0 auf der Bahn
figure-level_set_means = ξ = s(y): eine Funktion, die auf der Bahn 0 ist
figure-eta1_means = η₂¹ = θ: Ort des nächsten Punktes, längs der Bahn
figure-eta2_means = η₂²: wie schnell sich dieser Ort längs der Bahn bewegt
figure-u_means = u: was jeder Motor gibt
figure-motor = Motor { $number }
figure-law = Wechsel des Regelgesetzes
figure-held = festgehalten
figure-film = Einstellungen und Verläufe
figure-distance =
    Abstand von
    der Bahn  [mm]
figure-torques =
    Drehmoment $u$
    { "[" }N m]
figure-forces = Kraft $u$  [N]
figure-mixed = $u$  [N m, N]

## Tasten und Hilfe

key-run = Laufen lassen oder Pause
key-right = Ein Schritt; ist ein Punkt ausgewählt: ihn nach rechts schieben
key-left = Den ausgewählten Punkt nach links schieben
key-up = Den ausgewählten Punkt nach oben schieben
key-down = Den ausgewählten Punkt nach unten schieben
key-reset = Beide Roboter zurücksetzen
key-hold = Festhalten oder loslassen
key-next = Den nächsten Kontrollpunkt auswählen
key-none = Keinen Punkt auswählen
key-add = Einen Kontrollpunkt hinter dem ausgewählten einfügen
key-remove = Den ausgewählten Kontrollpunkt entfernen
key-undo = Eine Änderung der Bahn rückgängig machen
key-redo = Eine Änderung der Bahn wiederholen
key-pull_left = Die Spitzen nach links ziehen
key-pull_right = Die Spitzen nach rechts ziehen
key-pull_up = Die Spitzen nach oben ziehen
key-pull_down = Die Spitzen nach unten ziehen
key-let_go = Die Spitzen loslassen
key-wall = Eine Wand aufstellen oder wegnehmen
key-wall_left = Die Wand nach links schieben
key-wall_right = Die Wand nach rechts schieben
key-wall_up = Die Wand nach oben schieben
key-wall_down = Die Wand nach unten schieben
key-wall_turn = Die Wand gegen den Uhrzeigersinn drehen
key-wall_turn_back = Die Wand im Uhrzeigersinn drehen
key-back = Eine Sekunde weiter zurückblicken
key-forward = Eine Sekunde nach vorn blicken
key-go_on = Von dem Augenblick aus weiter, den du siehst; was danach kam, wird verworfen
key-undo_go_on = Zurückholen, was beim Weitergehen aus der Vergangenheit verworfen wurde
key-slowly = Wenn ein Roboter stehen geblieben ist: seine letzten Augenblicke langsam zeigen
key-earlier = Wenn ein Roboter stehen geblieben ist: mit den letzten Einstellungen zurücksetzen, mit denen es ging
key-summary = Sagen, was zu sehen ist
key-view = Die Ansicht zurücksetzen
key-lesson = Die erste Lektion öffnen

keyname-space = Leertaste
keyname-Esc = Esc
keyname-Ins = Einfg
keyname-Del = Entf
keyname-Home = Pos1
keyname-Ctrl = Strg

help-title = Wie das Labor zu bedienen ist
glossary-to_terms = Glossar: von den Wörtern der Lektionen zu den Fachwörtern
glossary-to_words = Glossar: von den Fachwörtern zu den Wörtern der Lektionen
glossary-lesson = (Lektion { $number })
help-close = Schließen

## Was das Labor von selbst sagt

say-stopped = { $robot }: stehen geblieben bei { $time } s: { $reason }. Zurücksetzen beginnt von vorn.
say-slowly = { $robot }: stehen geblieben bei { $time } s: { $reason }. Die letzten Augenblicke, langsam.
say-slowly_larger = { $robot }: stehen geblieben bei { $time } s: { $reason }. Die letzten Augenblicke, langsam; Biegung { $larger }-fach gezeichnet.
say-refused = Diese Bahn geht nicht: { $reasons }. Die vorige bleibt.
say-ambiguous = Hinweis: { $reasons }. Diese Gesetze bleiben auf dem Strang, auf dem sie sind; eines, das auf der ganzen Bahn sucht, könnte auf den anderen springen.
say-deviates = Die Bahn ist glatt: Stellenweise ist sie { $deviation } mm von den Linien zwischen den gegebenen Punkten entfernt.
say-deviation = Die Bahn weicht höchstens { $deviation } mm von der Zeichnung ab.
say-no_further = Weiter geht die Bahn nicht: { $reasons }.
say-level_set_ends = Diese Bahn hat keine Niveaumenge: Quer zu ihr wird wieder der Abstand gemessen.
say-begun_anew = Mit dieser Änderung haben beide Roboter neu begonnen, am Start.
say-ramps_at_start = Das Tempo wird vom Beginn eines Laufs an hochgefahren: Drücke Zurücksetzen, um es zu sehen.
say-nothing_to_undo = An dieser Bahn gibt es keine Änderung rückgängig zu machen. Jeder Roboter behält seine eigene Bahn.
say-nothing_discarded = Es ist nichts verworfen worden, was sich zurückholen ließe.
say-pull_paused = Die Zeit steht. Die Hand zieht, sobald sie weiterläuft.
say-nothing_to_redo = An dieser Bahn gibt es keine Änderung zu wiederholen.
say-select_first = Wähle erst einen Kontrollpunkt: Drücke auf einen, oder wähle seine Nummer.
say-laws_replaced = Nicht für diesen Roboter: { $laws }. An dieser Stelle steht ein übliches Gesetz.
say-law_interpreted = Dieses Regelgesetz wird interpretiert statt übersetzt, was etwa 30-mal so lange dauert: { $reason }.
say-looking_back = Das ist die Vergangenheit. „Zurück zu jetzt“ kehrt in die Gegenwart zurück; „Von hier aus weiter“ verwirft, was danach kam, und lässt sich rückgängig machen.
say-let_go = Die Spitzen sind losgelassen.
say-waits = Das Lab arbeitet noch; es geht gleich weiter.
say-present = Zurück in der Gegenwart.
say-set_up = Das Labor ist nach dem Code eingerichtet. Rückgängig im Bahneditor holt die frühere Bahn zurück.
say-went_on = Weiter ab { $time } s. Die { $seconds } s danach sind verworfen, bis du „Verworfenes zurückholen“ drückst.
say-brought_back = Zurück bei { $time } s, wie vor dem Weitergehen. Was stattdessen geschah, liegt beiseite; „Verworfenes zurückholen“ wechselt dorthin zurück.

identified-found = Aus den letzten { $seconds } s des rechten Roboters: { $values }.
identified-value = { $value }, vorher { $before }
identified-and = { " " }und{ " " }
identified-limited = { " " }{ $names }: so weit, wie sich das Modell verstellen lässt.
identified-also = { " " }Außerdem am Werk, aber nicht im Modell der Regler: { $values }.
identified-unexplained = { " " }{ $percent } % des Drehmoments sind nicht erklärt.
identified-other_robot = Identifizieren lässt sich nur das Fünfgelenk: Wähle erst diesen Roboter.

## Routen durch die Lektionen

route-route = Route
route-send = Diese Route für alle öffnen
route-follow = Dieser Route folgen
route-stop = { $lesson }, Schritte { $first } bis { $last }, { $minutes } min
route-here = { $route }: Teil { $stop } von { $stops }, bis Schritt { $last }, { $minutes } min

## Handreichung und Arbeitsblätter (app/exports/guide.py)

guide-title = Handreichung für Lehrkräfte
guide-intro = Zuerst eine Stunde mit einer Klasse, dann das, was jede Lektion fragt, der Reihe nach, mit den Antworten. Die Klasse soll sich auf jede Vorhersage festlegen, bevor man etwas sieht. Stelle dann die hier vorgeschlagene Frage, lass Nachbarn diskutieren, und zeige erst danach, was geschieht. Die Buchstaben sind die der Präsentation; Arbeitsblätter haben eigene, die auch in ihren Lösungen stehen, und die Labore der Lernenden zeigen die Möglichkeiten in anderer Reihenfolge.
guide-assumed = Nichts davon ist in einer Klasse gemessen. Die Minuten sind aus Wörtern, Läufen und Aufgaben der Lektionen geschätzt; was Lernende zeichnen oder sagen könnten, ist die Erwartung der Verfasser; und wie viel sie lernen, ist nicht bekannt. Mit dem Konzepttest lässt sich das in der eigenen Klasse messen.
guide-cite = Zum Zitieren: für die Theorie Hladio, Nielsen, Wang: „Path following for mechanical systems: experiments and examples“; für Lektionen, Abbildungen und Durchgänge OnPath, Version { $version }.
guide-hour = Eine Stunde mit einer Klasse
guide-before = Vorher
guide-begin = Starte die Klasse mit der Zeile oben, auf einem Rechner, der anbleibt und im Netz der Lernenden ist. Du bekommst die Adresse der Klasse, auch als QR-Code, und nach der Eingabetaste den Schlüssel der Lehrkraft; beide sind bei jedem Start dieselben.
guide-key = Öffne die Adresse, wähle { $teacher }, wo nach einem Spitznamen gefragt wird, und gib den Schlüssel ein.
guide-reach = Öffne die Adresse auch auf einem Handy. Kommt nichts, so sperrt eine Firewall den Port, oder das Netz trennt die Geräte voneinander, wie viele Gästenetze es tun: Dann brauchst du ein anderes Netz oder einen Server, den alle erreichen (assets/deploy/README.md, auf Englisch).
guide-places = Jede offene Seite braucht einen Platz, auch der zweite Tab derselben Person. Es gibt 80 (--most-clients), für ein einzelnes Netz höchstens 75. Wer keinen bekommt, wartet, bis einer frei wird. Ein Rechner mit zwei Kernen hat sechzig Seiten bedient.
guide-plain = Nichts ist verschlüsselt: Wer im Netz mithört, liest die Antworten und, wenn du ihn eintippst, auch deinen Schlüssel. In SECURITY.md stehen die zwei Zeilen, die das ändern (auf Englisch).
guide-kept = Von jeder Person speichert der Rechner den Spitznamen, Vorhersagen und gezeichnete Kurven, Antworten, auch die in eigenen Worten, Aufgaben, Verstärkungen und wann sie zuletzt da war; einen richtigen Namen oder eine Adresse nur, wenn du danach fragst. Du siehst das alles unter dem Spitznamen; andere Benutzer des Rechners können die Datei nicht öffnen. Die Klasse mit ihren Spitznamen wird eine Woche nach ihrer letzten Änderung gelöscht (--keep-class-days), ein Labor ein Jahr nach seiner letzten Benutzung, und beides früher, wenn du oder die Person es will. Mit --privacy-url und einer Adresse steht dort, wo nach dem Spitznamen gefragt wird, ein Link zu deiner Datenschutzerklärung.
guide-paper = Drucke für alle ein Arbeitsblatt, zwei bis vier Seiten (--variant 0 hat die Buchstaben der Leinwand), und für dich die Lösungen dazu und diese Handreichung, mit den Lektionen, die du brauchst:
guide-offline = Ohne Netz öffnet die erste Zeile das Labor auf deinem Rechner, für den Beamer; abgestimmt wird per Handzeichen oder auf den Arbeitsblättern. Die zweite schreibt die Lektionen als Seiten, für einen Stick oder irgendeinen Webserver:
guide-lecture = Eine dieser Seiten, lecture.de.html, ist ein Vortrag von 20 Minuten, mit Notizen für dich.
guide-during = In der Stunde
guide-wall = Die Lernenden öffnen die Adresse und geben einen Spitznamen ein. Auf deiner Seite stehen unter { $class } zwei Links: { $wall }, und { $remote }. Auf der Leinwand stehen dann die Adresse, die Frage und, sobald du sie zeigst, die Antworten; sie folgt dir.
guide-send = Wähle unter { $predictions } eine Route und dann { $route }, oder eine Lektion und einen Schritt und dann { $step }. Das kommt auch zu denen, die später beitreten.
guide-vote = Ist eine Frage offen, so werden die Antworten gezählt. { $show } beendet die Abstimmung nach fünf Sekunden, oder sobald alle geantwortet haben. Liegen weniger als 30 % richtig, erkläre; bis 70 % lass Nachbarn diskutieren und drücke { $again }; darüber geh weiter.
guide-next = { $next } bringt alle zum nächsten Schritt, wo die Lernenden geschehen lassen, was sie vorhergesagt haben. { $play }, unter { $predictions }, tut es mit deinen Robotern. Bei { $freeze } schauen alle nach vorn.
guide-trouble = Eine Seite, die ihre Verbindung verloren hat, kommt von selbst wieder, oder wenn man sie neu lädt, mit allem, was schon beantwortet war. Wer das Gerät wechselt, gibt dort denselben Spitznamen ein; mit { $yes }, unter { $class }, gibst du den Platz zurück. Fällt dein Rechner aus, so starte ihn mit derselben Zeile: Die Klasse geht weiter, wo sie war.
guide-after = Danach
guide-record = { $export }, unter { $record }: eine Arbeitsmappe mit einer Zeile für jede Antwort und ihrer Zeit.
guide-marks = Punkte wollen vor der Stunde entschieden sein: Unter { $record }, { $asks }, wähle E-Mail-Adresse, Matrikelnummer oder Anmeldenamen, denn die geben die Lernenden selbst ein, nach einem Druck auf ihren Namen. Die Arbeitsmappe hat dann ein Blatt für Moodle, mit dem Anteil der Fragen jeder Lektion, die beantwortet sind, richtig oder falsch. Was richtig war, bewertet eine Lernplattform, die die Lektion als Paket hat:
guide-end = { $end } löscht Spitznamen und Ergebnisse, { $forget } auch die Labore der Lernenden. Sichere die Arbeitsmappe vorher.
guide-needs = Voraussetzungen
guide-goals = Danach können die Lernenden
guide-misconception = Die Fehlvorstellung
guide-timing = Schritt
guide-minutes = Minuten
guide-and_optional = und { $minutes } freiwillig
guide-sketch = Vorhersage: eine Kurve
guide-choice = Vorhersage
guide-quiz = Frage
guide-number = Frage, eine Zahl
guide-within = { $number } { $unit }, auf { $tolerance } { $unit } genau
guide-derivation = Herleitung, Zeile für Zeile
guide-open = Frage, mit eigenen Worten
guide-reasons = Begründungen zur Wahl:
guide-task = Aufgabe
guide-ask = Zu fragen, bevor man es sieht:
guide-usual = Gezeichnet wird vielleicht:
guide-second = Nach einer falschen Antwort gefragt, bevor die richtige verraten wird:
guide-distractors = Was Lernende sagen könnten, und die Antwort darauf:
guide-answer = Was geschieht:
guide-right = Richtig:
guide-wrong = Bekannter Fehler:
guide-curves = Die wirklichen Kurven beider Roboter
guide-solution = Eine Lösung
guide-why = Warum sie geht:
guide-otherwise = Anders geschafft:
guide-exploratory = durch Ausprobieren, ohne Wertung
guide-test = Konzepttest
guide-test_intro = Zwei Formen mit verschiedenen Fragen zu denselben Vorstellungen. Die eine Hälfte der Klasse hat Form A vor dem Kurs und Form B danach, die andere Hälfte umgekehrt; das entscheidet das Los. Öffne den Test für die Klasse auf der Seite „Vorhersagen“; die Lösungen werden erst verraten, wenn der zweite Test abgegeben ist, also besprich sie nicht vorher. Ab zwanzig Personen stehen auf derselben Seite und in den Ergebnissen der Klasse der normierte Lernzuwachs und zu jeder Frage, wie schwer sie ist und wie gut sie unterscheidet, mit Intervallen und ohne Namen. Am 30. November 2026 kamen drei Leser, die Regelungstechnik kennen, aber weder die Fragen geschrieben hatten noch den Kurs kannten, bei jeder Frage auf die vorgesehene Lösung, und nach einer Überarbeitung drei andere ebenso; was denen noch unklar war, wurde danach umformuliert. Gemessen wurde noch niemand: Dass beide Formen gleich schwer sind und die Fragen etwas taugen, ist angenommen.
guide-test_one = Dieselben Fragen vor und nach dem Kurs. Öffne sie für die Klasse auf der Seite „Vorhersagen“; die Lösungen werden erst verraten, wenn der zweite Test abgegeben ist, also besprich sie nicht vorher. Ab zwanzig Personen steht der normierte Lernzuwachs der Klasse dann auf derselben Seite und in den Ergebnissen der Klasse, ohne Namen.
guide-test_apart = Der Konzepttest und seine Lösungen stehen nicht in dieser Handreichung, damit man sie weitergeben kann: `onpath lessons guide --concept-test` fügt sie hinzu. Gemessen wurde mit diesem Test noch niemand.
guide-test_when = Er braucht { $minutes } Minuten vor der ersten Stunde und ebenso viele nach der letzten. Die Lernenden finden ihn unter { $lessons }, als die letzten beiden Einträge, auch zu Hause, wenn dein Rechner von dort zu erreichen ist. Oder öffne ihn für alle: Wähle unter { $predictions } die Lektion { $before } oder { $after } und dann { $step }. Danach geht jede Person ihn für sich durch und gibt ihn ab. Eine Klasse, die eine Woche lang niemand benutzt, wird gelöscht: Sind die Pausen zwischen den beiden Tests länger, so starte mit --keep-class-days 120.
guide-treated = Behandelt in:
guide-page = Lektion { $lesson }, Seite { $step }
guide-transfer = über andere Körper als die der Lektionen
guide-aims = Zielt auf die Vorstellung:
guide-at = bei { $time } s: { $what }
guide-pull = um { $right } mm nach rechts und { $up } mm nach oben ziehen
guide-move = Kontrollpunkt { $index } um { $right } mm nach rechts und { $up } mm nach oben verschieben
guide-run = laufen lassen
guide-pause = anhalten
guide-rate = simulierte Zeit mit dem { $rate }-fachen Tempo der Uhr
guide-start = an einer anderen Stelle beginnen
worksheet-title = Arbeitsblatt: { $lesson }
worksheet-key = Lösungen: { $lesson }
worksheet-variant = Variante { $number }
worksheet-name = Name
worksheet-date = Datum
worksheet-axes = Achsen, in die gezeichnet wird
worksheet-because = Weil
worksheet-sure = Wie sicher?
worksheet-after = Aufgaben und Fragen
worksheet-done = Was ging, und warum:
worksheet-learnt = Was ich vorher dachte und jetzt denke:

## Wovon das Englische in models/ steht

path-circle = Kreis
path-ellipse = Ellipse
path-rounded-square = abgerundetes Quadrat
path-clover = Kleeblatt
path-segment = gerade Strecke
path-figure-of-eight = liegende Acht

machine-five_bar-label = Fünfgelenk
machine-five_bar-text = Zwei Motoren, starre Glieder, ein Stift in einer senkrechten Ebene.

machine-flexible-label = Fünfgelenk mit elastischem Glied
machine-flexible-text = Drei Motoren, ein letztes Glied, das sich biegt: Die Spitze ist nicht dort, wo die Motoren sie haben wollen.

machine-cart_pendulum-label = Wagen mit Pendel
machine-cart_pendulum-text = Zwei Motoren bewegen einen Stift auf einem Wagen, keiner das Pendel, das an ihm hängt oder auf ihm steht.
machine-hovercraft-label = Luftkissenboot
machine-hovercraft-text = Zwei Gebläse schieben drei Koordinaten, von oben gesehen: Seitwärts schiebt nichts.

machine-planar_arm-label = Ebener Arm mit drei Gelenken
machine-planar_arm-text = Drei Motoren, einer mehr, als die Bahn braucht: Neben der Bahn wird eine Haltung gehalten.

machine-rod_gantry-label = Portal mit Stange
machine-rod_gantry-text = Zwei Motoren bewegen einen Schlitten, keiner die Stange, die mit dem Stift an ihm hängt.

machine-seven_axes-label = Arm mit sieben Gelenken
machine-seven_axes-text = Sieben Motoren: Ohne seine Haltung fällt der Arm, aber seine Spitze bleibt auf der Bahn.

machine-spatial_arm-label = Raumarm
machine-spatial_arm-text = Drei Motoren, einer dreht den Arm um die Senkrechte: Seine Bahn darf die Ebene verlassen.

machine-two_link_arm-label = Zweigelenkarm
machine-two_link_arm-text = Zwei Motoren, einer an der Schulter und einer am Ellbogen, gegen die Schwerkraft.

parameter-rate-label = Tempo der Zeit
parameter-rate-help = simulierte Sekunden je Sekunde: unter 1 bewegen sich beide Roboter in Zeitlupe

parameter-copy-label = Für beide
parameter-copy-help = Ziehen und Festhalten wirken auf beide Roboter gleich; man sieht, was die Gesetze daraus machen

parameter-hold_direction-label = Halten wirkt
parameter-hold_direction-help = welche Bewegung das Halten verhindert: längs der Bahn, quer zu ihr oder beide
parameter-hold_direction-option-along = längs
parameter-hold_direction-option-across = quer
parameter-hold_direction-option-both = beide

parameter-larger-label = Vergrößert
parameter-larger-help = so viel größer wird die Biegung gezeichnet; die Bewegung bleibt dieselbe

parameter-start_theta-label = Start: Ort
parameter-start_theta-help = der Punkt der Bahn, bei dem beide Roboter den nächsten Lauf beginnen

parameter-start_beside-label = Start: neben der Bahn
parameter-start_beside-help = so weit neben der Bahn beginnen beide, nach links positiv

parameter-start_along-label = Start: Tempo längs
parameter-start_along-help = die Geschwindigkeit längs der Bahn, mit der beide beginnen

parameter-start_across-label = Start: Tempo quer
parameter-start_across-help = die Geschwindigkeit quer zur Bahn, mit der beide beginnen, nach links positiv

parameter-start_clock_offset-label = Start: Vorsprung der Uhr
parameter-start_clock_offset-help = so weit voraus beginnt der Punkt eines Gesetzes mit Uhr

parameter-wall-label = Wand
parameter-wall-help = eine Wand im Weg beider Roboter, die ein wenig nachgibt

parameter-wall_z1-label = Wand: nach rechts
parameter-wall_z1-help = wo die Mitte der Wand ist, nach rechts

parameter-wall_z2-label = Wand: nach oben
parameter-wall_z2-help = wo die Mitte der Wand ist, nach oben

parameter-wall_angle-label = Wand: Winkel
parameter-wall_angle-help = Richtung der freien Seite, gegen den Uhrzeigersinn von rechts aus; 90° ist oben

parameter-presenting-label = Große Schrift
parameter-presenting-help = die Texte sind größer, wie für einen Beamer

parameter-K1-label = K1 quer
parameter-K1-help = Feder, die auf die Bahn zurückzieht

parameter-K2-label = K2 quer
parameter-K2-help = dämpft die Bewegung quer zur Bahn

parameter-K3-label = K3 quer
parameter-K3-help = beseitigt eine bleibende Abweichung (Integral)

parameter-tracker_integral-label = Integral im Nachläufer
parameter-tracker_integral-help = ob K3 auch in einem Gesetz wirkt, das der Uhr folgt: Festgehalten lädt sich dessen Integral auf
parameter-tracker_integral-option-off = aus
parameter-tracker_integral-option-on = ein

parameter-K4-label = K4 längs
parameter-K4-help = Feder zum Ziel auf der Bahn

parameter-K5-label = K5 längs
parameter-K5-help = wie streng die Geschwindigkeit längs der Bahn eingehalten wird

parameter-task-label = Auftrag
parameter-task-help = mit einer Geschwindigkeit die Bahn entlang, oder an einen Ort auf ihr
parameter-task-option-speed = Tempo
parameter-task-option-position = Ort

parameter-speed-label = Tempo
parameter-speed-help = gewünschte Geschwindigkeit längs der Bahn; negativ: rückwärts; mit einem Tempo-Verlauf: der Mittelwert des Sinus, sonst das größte Tempo

parameter-ramp-label = Tempo-Rampe
parameter-ramp-help = wie schnell sich das gewünschte Tempo ändert; 0: sofort

parameter-speed_profile-label = Tempo-Verlauf
parameter-speed_profile-help = wie sich das gewünschte Tempo vom Beginn eines Laufs an ändert: aus der Ruhe hinauf, als Sinus um das Tempo, oder Halt und Fahrt; er wird nach (19) vorgesteuert und ersetzt die Rampe
parameter-speed_profile-option-constant = gleichbleibend
parameter-speed_profile-option-ramp_up = Anfahren
parameter-speed_profile-option-sine = Sinus
parameter-speed_profile-option-stop_and_go = Halt und Fahrt

parameter-profile_period-label = Dauer des Verlaufs
parameter-profile_period-help = Periode des Sinus und von Halt und Fahrt; beim Anfahren die Zeit, bis das Tempo erreicht ist

parameter-target-label = Ziel
parameter-target-help = wo er stehen bleiben soll, beim Auftrag Ort

parameter-across-label = Quer gemessen
parameter-across-help = was quer zur Bahn gemessen wird: der Abstand, oder s(y) wie im Artikel in m² (Ellipsen; auf der Kommandozeile auch Polynome, in m)
parameter-across-option-distance = Abstand
parameter-across-option-level_set = Niveaumenge

parameter-torque_limit-label = Motorgrenze
parameter-torque_limit-help = mehr geben die Motoren nicht her; 0: keine Grenze

parameter-at_limit-label = An der Motorgrenze
parameter-at_limit-help = was geschieht, wenn eine Motorgrenze erreicht ist: Gesetze, die eine Beschleunigung verlangen, geben erst die Geschwindigkeit längs der Bahn auf, dann die Bahn; langsamer: und Bahnfolge und eingetippte Gesetze verlangen nur eine Geschwindigkeit, die die ganze Bahn zulässt; abschneiden: keins von beiden
parameter-at_limit-option-across_first = quer zuerst
parameter-at_limit-option-slow_down = langsamer
parameter-at_limit-option-cut = abschneiden
parameter-at_limit_for-label = Gesetze, die nachgeben
parameter-at_limit_for-help = welche Gesetze an einer Motorgrenze Geschwindigkeit längs der Bahn aufgeben: alle, die eine Beschleunigung verlangen, oder nur Bahnfolgeregelung und eingetippte Gesetze
parameter-at_limit_for-option-all = alle Gesetze
parameter-at_limit_for-option-path_following = nur Bahnfolge

parameter-clock_gain-label = Uhr wartet
parameter-clock_gain-help = wie stark die wartende Uhr den Fehler längs der Bahn spürt; 0: eine gewöhnliche Uhr

parameter-maneuver_gain-label = Punkt steigt ab
parameter-maneuver_gain-help = wie stark der Punkt der Manövrierregelung den Gradienten absteigt; 0: eine gewöhnliche Uhr

parameter-observer_rate-label = Rate des Beobachters
parameter-observer_rate-help = wie schnell der Störbeobachter eine bleibende Kraft findet; 0: Er sucht keine

parameter-observer_bound-label = Grenze des Beobachters
parameter-observer_bound-help = die größte Beschleunigung, die der Störbeobachter seiner Schätzung entgegensetzt

parameter-orbit_swing-label = Ausschlag
parameter-orbit_swing-help = Amplitude des Pendels auf dem Orbit

parameter-contour_ratio-label = Längs / quer
parameter-contour_ratio-help = Konturregelung: Steifigkeit längs der Bahn, als Anteil der Steifigkeit quer dazu

parameter-field_gain-label = Feld zur Bahn
parameter-field_gain-help = Geschwindigkeitsfeld: wie schnell es zur Bahn zurückführt

parameter-field_circulation-label = Feld dreht
parameter-field_circulation-help = Geschwindigkeitsfeld: wie schnell sich die Geschwindigkeit in das Feld dreht

parameter-field_energy-label = Feldenergie
parameter-field_energy-help = Geschwindigkeitsfeld: Energie von Roboter und Schwungrad zusammen

parameter-encoder_counts-label = Drehgeber
parameter-encoder_counts-unit = je Umdrehung
parameter-encoder_counts-help = Schritte der Drehgeber in den Gelenken; 0: genaue Messung

parameter-encoder_filter-label = Filterzeit
parameter-encoder_filter-help = Zeitkonstante des Filters hinter den Drehgebern, wenn es keinen Beobachter gibt; ohne Stufen und ohne Rauschen bewirkt sie nichts

parameter-observer_time-label = Beobachter
parameter-observer_time-help = die Geschwindigkeiten schätzt ein Beobachter mit dem Modell des Reglers; in dieser Zeit vergisst er Fehler. 0: der Filter liefert sie; ohne Stufen und ohne Rauschen bewirkt sie nichts

parameter-coulomb-label = Trockene Reibung
parameter-coulomb-help = trockene Reibung in den Gelenken; 0: keine

parameter-stiction-label = Haftreibung
parameter-stiction-help = bis zu diesem Drehmoment bleibt ein ruhendes Gelenk in Ruhe, danach gleitet es mit der trockenen Reibung; 0: keine

parameter-torque_step-label = Drehmomentstufen
parameter-torque_step-help = das Drehmoment der Motoren ist ein Vielfaches davon; 0: beliebig

parameter-look_ahead-label = Vorausschau
parameter-look_ahead-help = wie weit der Regler vorausrechnet: eine halbe Millisekunde, oder einen halben Regeltakt, was bei langsamem Takt die Geschwindigkeit richtig hält, aber das größte K2 halbiert
parameter-look_ahead-option-half_tick = halbe Millisekunde
parameter-look_ahead-option-half_interval = halber Regeltakt
parameter-delay-label = Rechenzeit
parameter-delay-unit = Regeltakte
parameter-delay-help = Zeit von einer Messung bis zum Drehmoment, das aus ihr berechnet wird; 0: sofort

parameter-sensor_noise-label = Messrauschen
parameter-sensor_noise-help = Standardabweichung der gemessenen Gelenkwinkel

parameter-seed-label = Startwert des Rauschens
parameter-seed-help = wählt die Zufallszahlen des Rauschens: gleicher Startwert, gleicher Lauf

parameter-strain_noise-label = Rauschen der Dehnmessstreifen
parameter-strain_noise-help = Standardabweichung der Durchbiegung an der Spitze, wie die Dehnmessstreifen sie messen

parameter-control_rate-label = Reglertakt
parameter-control_rate-help = wie oft der Regler eingreift. Die Pole bei den Verstärkungen gelten für eine Beschleunigung, die dazwischen gehalten wird; gehalten wird das Drehmoment, sodass das größte K2 bei 50 und 100 Hz um 1 bis 3 % über ihrem liegt

parameter-error_inertia-label = Fehler: Trägheit
parameter-error_inertia-help = um so viel liegen die Trägheiten a1, a2 und a3 im Modell des Reglers daneben

parameter-rise-label = Höhe der Bahn
parameter-rise-help = um so viel steigt und fällt die Bahn, zweimal je Umlauf: ein Sattel

parameter-error_inertias-label = Fehler: Trägheit
parameter-error_inertias-help = um so viel liegen die Trägheiten a1, a2, a3 und k im Modell des Reglers daneben

parameter-error_weights-label = Fehler: Gewicht
parameter-error_weights-help = um so viel liegen die Gewichte g2 und g3 im Modell des Reglers daneben

parameter-error_gravity-label = Fehler: Gewicht
parameter-error_gravity-help = um so viel liegen die Gewichte im Modell des Reglers daneben

parameter-error_M11-label = Fehler: Trägheit, Motor 1
parameter-error_M11-help = um so viel liegt M11, das Trägheitsmoment an Motor 1, im Modell des Reglers daneben

parameter-error_M22-label = Fehler: Trägheit, Motor 2
parameter-error_M22-help = um so viel liegt M22, das Trägheitsmoment an Motor 2, im Modell des Reglers daneben

parameter-error_b1-label = Fehler: Reibung, Motor 1
parameter-error_b1-help = um so viel liegt b1, die Reibung an Motor 1, im Modell des Reglers daneben

parameter-error_b2-label = Fehler: Reibung, Motor 2
parameter-error_b2-help = um so viel liegt b2, die Reibung an Motor 2, im Modell des Reglers daneben

parameter-counterweights_removed-label = Gegengewichte ab
parameter-counterweights_removed-help = abgenommene Gegengewichte; der Regler weiß nichts davon

parameter-b-label = b
parameter-b-help = Steigung der Ebene y1 = b y2 + d der Bahn, Gl. (23); ein Kreis in y2 und y3 ist darin eine Ellipse
parameter-d-label = d
parameter-d-help = Abstand dieser Ebene von der Hüfte, bei y2 = 0
parameter-centre-label = Mitte y3
parameter-centre-help = Höhe y3 der Mitte der Bahn
parameter-posture_stiffness-label = Haltungsfeder
parameter-posture_stiffness-help = Feder, die die Gelenke zur Ausgangsstellung zieht, soweit das die Spitze nicht bewegt; 0: keine

parameter-posture_damping-label = Haltungsdämpfer
parameter-posture_damping-help = Dämpfer der Gelenkbewegung, die die Spitze nicht bewegt; 0: keiner
parameter-limit_avoidance-label = Abstand von Anschlägen
parameter-limit_avoidance-help = wie sehr ein Gelenk vom Ende seines Wegs ferngehalten wird, wo sich stattdessen andere bewegen können, ohne dass sich die Spitze bewegt; 0: gar nicht

parameter-payload-label = Last
parameter-payload-help = Masse an der Spitze; der Regler weiß nichts davon, und sein Integral hebt nicht mehr, als sonst 10 mm tief hinge

parameter-alpha-label = α
parameter-alpha-help = Anteil der Biegung oder des Pendelns, den der Regler sieht: 1 der ganze, 0 nichts davon

parameter-rod-label = Stange
parameter-rod-help = Masse der hängenden Stange

parameter-pivot-label = Dämpfung im Gelenk
parameter-pivot-help = Dämpfung im Drehgelenk, das keinen Motor hat

parameter-pendulum-label = Pendel
parameter-pendulum-help = ob das Pendel am Wagen hängt oder auf ihm steht
parameter-pendulum-option-hanging = hängt
parameter-pendulum-option-upright = steht
parameter-pen-label = Stift
parameter-pen-help = wo auf der Achse des Bootes der Stift sitzt, der auf der Bahn sein soll
parameter-pen-option-front = vorn
parameter-pen-option-centre = im Schwerpunkt
parameter-pen-option-behind = hinten
parameter-drag-label = Luftwiderstand
parameter-drag-help = Widerstand der Luft am Schwerpunkt

parameter-mass-label = Masse
parameter-mass-help = Masse des Pendels

parameter-output-label = Ausgang
parameter-output-help = was der Regler auf die Bahn bringt: y mit einem Anteil der Durchbiegung, oder die Spitze selbst
parameter-output-option-redefined = neu definiert
parameter-output-option-composite = zusammengesetzt

parameter-tip_damping-label = Spitze dämpfen
parameter-tip_damping-help = Dämpfungsgrad, den die Hüfte dem Balken gibt

parameter-tip_prediction-label = Vorhersage der Spitze
parameter-tip_prediction-help = wie schnell die Durchbiegung vorhergesehen wird

parameter-tip_shaping-label = Sanftes Tempo
parameter-tip_shaping-help = wie schnell sich das gewünschte Tempo ändern darf

parameter-tip_yielding-label = Nachgeben
parameter-tip_yielding-help = wie stark das Fortschreiten längs der Bahn nachgibt, wenn die Spitze festgehalten wird

parameter-plant-label = Regelstrecke
parameter-plant-help = die Lagrange-Gleichungen, oder (20)-(21) mit ∫φ² = 1 gelesen: Die Einheiten passen nicht, und es gibt keine Gelenkreibung; der Lauf beginnt neu
parameter-plant-option-lagrangian = nach Lagrange
parameter-plant-option-unit_modes = Moden mit ∫φ² = 1

parameter-modes-label = Moden
parameter-modes-help = wie viele Moden des Balkens simuliert werden; der Lauf beginnt neu

parameter-rho-label = ρ
parameter-rho-help = Masse des Balkens je Meter

parameter-frequency-label = Erste Frequenz
parameter-frequency-help = erste Frequenz des eingespannten Balkens

parameter-zeta-label = Dämpfung ζ
parameter-zeta-help = Dämpfungsgrad jeder Mode

parameter-error_J0-label = Fehler: Trägheit der Hüfte
parameter-error_J0-help = um so viel liegt das Trägheitsmoment J0 der Hüfte im Modell des Reglers daneben

parameter-error_rho-label = Fehler: Masse des Balkens
parameter-error_rho-help = um so viel liegt ρ, die Masse je Länge des Balkens, im Modell des Reglers daneben

parameter-error_omega1-label = Fehler: erste Frequenz
parameter-error_omega1-help = um so viel liegt die erste Frequenz im Modell des Reglers daneben

report-title = Bericht über meine Lektionen
report-made = Erstellt am { $date }
report-date = %d.%m.%Y um %H:%M
report-code = Code des Labors: { $code }
report-point = ,
report-none = Noch ist keine Lektion geöffnet worden.
report-lesson = Lektion
report-seen = Schritte gesehen
report-tasks = Aufgaben geschafft
report-made_of = Vorhersagen gemacht
report-right_of = Richtig gewählt
report-part = { $part } von { $all }
report-gone = Eine begonnene Lektion gibt es in diesem Kurs nicht mehr: { $name }.
report-strange =
    { $count ->
        [one] 1 Notiz, die nicht mehr zu dieser Lektion passt, fehlt hier.
       *[other] { $count } Notizen, die nicht mehr zu dieser Lektion passen, fehlen hier.
    }
report-predictions = Vorhersagen
report-to_do = Aufgaben
report-questions = Fragen
report-not_predicted = Du hast noch nichts vorhergesagt.
report-not_happened = Was wirklich geschieht, ist noch nicht zu sehen gewesen.
report-not_passed = Noch nicht geschafft.
report-not_answered = Noch nicht beantwortet.
report-chosen = Du hast gewählt:
report-right = Richtig ist:
report-curve = { $robot }: { $quantity }
report-drawn = Deine Kurve hat ihren größten Wert, { $value } { $unit }, bei { $time } s.
report-happened = Die größten Werte dessen, was wirklich geschah: { $first } und { $second }.
report-peak = { $robot } { $value } { $unit } bei { $time } s

## Wie ein Fehler abklingt (models/control/poles.py)

behaviour-settles = klingt in { $seconds } s ab, { $kind }
behaviour-no_overshoot = ohne Überschwingen
behaviour-no_oscillation = ohne Schwingung
behaviour-damping = Dämpfungsgrad { $damping }
behaviour-unstable = instabil: Ein Fehler wächst alle { $seconds } s auf das e-fache
behaviour-not_stable = nicht stabil: Ein Fehler klingt nie ab
behaviour-swings = nicht stabil: Ein Fehler schwingt ewig
behaviour-free = wie eine Perle auf einem Draht: Was sie an einer Stelle an Tempo gewinnt, verliert sie in einer Runde an einer anderen
behaviour-no_poles = für dieses Gesetz werden keine Pole berechnet
behaviour-not_constant = keine Pole: Das Gesetz hängt vom Ort oder von der Zeit ab oder gibt Drehmomente vor
behaviour-not_smooth = keine Pole: Auf der Bahn hat das Gesetz einen Knick oder Sprung, oder es bleibt nicht dort
behaviour-coupled = keine Pole: Die Bewegungen quer zur Bahn und längs der Bahn wirken aufeinander

## Warum eine Kurve keine Bahn sein kann (models/paths/curve_faults.py)

fault-not_numbers = die Kurve hat Punkte, die keine Zahlen sind
fault-outside = die Bahn verlässt den Arbeitsraum: Dorthin reicht der Arm nicht
fault-singular = die Bahn kommt einer singulären Stellung zu nahe: Dort ist der Arm gestreckt oder gefaltet und kann sich nicht in jede Richtung bewegen
fault-bends = die Bahn ist zu scharf gebogen: Eine Biegung braucht mindestens { $radius } mm Radius, sonst ist der nächste Punkt in ihrer Nähe nicht eindeutig
fault-cusp = die Bahn hat einen Umkehrpunkt, an dem sie keine Richtung hat
fault-crosses = die Bahn kreuzt sich selbst: An der Kreuzung ist der nächste Bahnpunkt nicht eindeutig
fault-narrow = zwei Stränge der Bahn liegen weniger als { $least } mm auseinander: Dazwischen ist der nächste Punkt nicht eindeutig

## Warum ein Roboter stehen geblieben ist (`fault` der Modelle)

stop-range = die Zahlen sind größer, als ein Rechner rechnen kann
stop-typed_law = das eingetippte Regelgesetz ergibt eine Zahl, die nicht endlich oder größer als { $most } ist
stop-own_law = { $law } ergibt eine Zahl, die nicht endlich oder größer als { $most } ist ({ $file }, Zeile { $line })
stop-called_law = { $law } wurde angehalten: { $reason } ({ $file }, Zeile { $line })
stop-fast = ein Gelenk dreht schneller als { $limit } rad/s: Die Bewegung ist divergiert
stop-collapsed = das Getriebe ist zusammengeklappt (alle Glieder auf einer Geraden): Aus einer singulären Stellung führt der Regler es nicht heraus
stop-singular = der Roboter ist nahe an einer singulären Stellung (zwei Glieder auf einer Geraden): Dort können seine Motoren die Spitze nicht in jede Richtung bewegen
stop-limit = der Roboter ist nahe an einer singulären Stellung oder am Ende eines Gelenkwegs: Seine Motoren können die Spitze nicht in jede Richtung bewegen
stop-joint = das Gelenk { $joint } hat seine Grenze von { $limit } überschritten
stop-joints = ein Gelenk hat seine Grenze überschritten
stop-crushed = ein Schlitten ist härter ans Ende seines Wegs gestoßen, als dessen Puffer aushält
stop-bent = der Balken biegt sich zu weit, obwohl seine Nulldynamik stabil ist: Der Zug ist zu stark, die Regelung zu langsam oder das Modell des Reglers zu falsch
stop-unstable = der Ausgang ist auf der Bahn, das Innere nicht: instabile Nulldynamik
stop-bent_or_unstable = der Balken biegt sich zu weit: Seine Nulldynamik ist instabil, der Zug zu stark, die Regelung zu langsam oder das Modell des Reglers zu falsch
stop-because = { $reason }. Vermutliche Ursache: { $causes }
refused-not_started = der Regler ist noch nicht gestartet
refused-time = die Zeit der Messung ist keine Zahl oder liegt vor der letzten
refused-late = zwei Regelintervalle lang kam keine Messung
refused-not_finite = ein Messwert ist keine endliche Zahl
refused-jump = ein gemessenes Gelenk ist weiter gesprungen, als es sich bewegen kann
refused-fast = ein Gelenk ist schneller als die Grenze, die dem Regler gesetzt ist
refused-no_torque = das Regelgesetz ergab eine Zahl, die nicht endlich ist
refused-stopped = jemand hat ihn angehalten
efforts-stated = Größte Drehmomente der Motoren laut seiner Datei: { $limits }.
efforts-exceeded = der Motor von { $joint } gab { $gave }, mehr als die { $limit }, die in der Datei des Roboters stehen; mit einer Motorgrenze von 100 % gibt er nicht mehr
caution-flexible = Mit { $rate } Regeleingriffen je Sekunde ist der biegsame Roboter auch unberührt nicht stabil: Er wird nach wenigen Sekunden stehen bleiben. Wähle mindestens { $slowest } Hz
caution-flexible_weak = Hinter Drehgebern oder Rauschen braucht das Gesetz für die Spitze des biegsamen Balkens mehr als { $limit } N m: Die Spitze kann sich aufschaukeln, und der Roboter stehen bleiben. Wähle eine höhere Grenze oder keine
forecast-singular = die Entkopplungsmatrix ist am Start singulär: Dort können die Motoren den Ausgang aus der Ruhe nicht in jede Richtung beschleunigen, sodass es für das, was das Regelgesetz verlangt, keine Drehmomente gibt
forecast-no_rest = der Roboter kann am Start nicht ruhen: Seine Koordinaten ohne Motor setzen sich in Bewegung, was immer die Motoren tun
forecast-unstable = die Nulldynamik ist instabil: Während der Ausgang auf der Bahn bleibt, wächst die Bewegung der Koordinaten ohne Motor, anfangs alle { $time } s auf das Zehnfache (Exponent { $rate } 1/s)
forecast-exhausted = schon Stillstehen braucht auf dieser Bahn { $share } % der Drehmomentgrenze: gegen die Schwerkraft und wegen der Messfehler. Für die Bewegung bleibt zu wenig: Der Roboter kann von der Bahn abkommen und stehen bleiben
forecast-unplanned = auf einer Zeichnung fahren die zeitoptimalen Gesetze mit der gewünschten Geschwindigkeit: Eine Zeichnung hat mehr Biegungen, als in ihren Plan der schnellsten Fahrt passen
forecast-unmodelled = die Bahnfolgeregelung kann hier weiter von ihrer Bahn abkommen als die Nachlaufregelung: Ihre Geschwindigkeiten kommen aus dem Modell des Reglers, und es gibt einen Fehler darin, eine Nutzlast, Reibung, Rechenzeit oder eine Drehmomentgrenze
cause-poles_across = diese Verstärkungen sind quer zur Bahn bei dieser Regelrate und Verzögerung instabil (K2 oder K3 senken oder die Rate erhöhen)
cause-poles_along = diese Verstärkungen sind längs der Bahn bei dieser Regelrate und Verzögerung instabil (K5 senken oder die Rate erhöhen)
cause-limit = die Motoren waren an ihrer Grenze von { $limit } { $unit } (anheben oder langsamer fahren)
cause-small_errors = sein Bezugspunkt war { $away } mm von ihm entfernt, und das Gesetz rechnet in dessen Achsen, die für kleine Fehler gedacht sind
cause-force = eine Kraft von { $force } N wirkte auf ihn
cause-far = er war dort, wo auf den nächsten Punkt kein Verlass ist
cause-turned = er drehte sich in einem Regelintervall um { $turned } rad (ein schnellerer Regler hilft)
cause-model = das Modell des Reglers ist falsch (Nutzlast und Modellfehler auf 0 setzen)

## Ablehnungen: die Punkte einer Bahn

error-point_not_finite = ein Kontrollpunkt braucht endliche Koordinaten
error-too_many_points = eine Bahn hat höchstens { $most } Kontrollpunkte
error-too_few_points = diese Bahn braucht mindestens { $least } Kontrollpunkte
error-no_point = Kontrollpunkt { $index }: Es gibt { $count }
error-stroke_not_finite = ein Strich braucht Punkte mit endlichen Koordinaten
error-stroke_without_points = ein Strich braucht Punkte
error-points_coincide = eine Bahn braucht mindestens { $least } Punkte, die auseinander liegen
error-path_too_short = die Bahn ist zu kurz: { $length } mm, mindestens { $least } mm
error-path_takes_no_numbers = die Bahn { $name } nimmt keine Zahlen
error-half_a_point = ein halber Punkt: Eine Bahn braucht so viele x wie y
error-points_out_of_bounds = 2 bis { $most } Punkte, höchstens { $reach } m von der Mitte
error-no_drawing = die Zahlen der Bahn sind nicht die einer Zeichnung
error-coefficients = eine gezeichnete Bahn hat { $wanted } Koeffizienten, nicht { $count }
error-implicit_lines =
    { $count ->
        [0] die Gleichung hat im Umkreis von { $region } mm keine Lösung: erwartet wird eine geschlossene Linie
        [one] die Lösungen der Gleichung sind eine offene Linie oder verlassen den Umkreis von { $region } mm: erwartet wird eine geschlossene Linie
       *[other] die Lösungen der Gleichung sind { $count } Linien: erwartet wird eine geschlossene Linie
    }
error-implicit_shape = die Lösungen der Gleichung haben eine Form, der eine glatte Bahn nicht folgen kann: Sie läge bis zu { $apart } mm daneben
error-no_level_set = diese Bahn hat keine Niveaumenge s(y): Eine solche haben hier nur Kreise und Ellipsen, und auf der Kommandozeile Bahnen mit einer Gleichung
error-level_set_crosses = diese Bahn kreuzt sich selbst: An der Kreuzung hat eine Niveaumenge s(y) keinen Gradienten; folge der Bahn nach ihrem Abstand
error-level_no_polynomial = mit der Niveaumenge lässt sich einer Bahn nur folgen, wenn ihre Gleichung ein Polynom in z1 und z2 ist; mit dem Abstand jeder Bahn mit einer Gleichung
error-level_gradient = mit dieser Niveaumenge lässt sich der Bahn nicht folgen: { $beside } mm neben ihr zeigt der Gradient von s nicht mehr von ihr weg, und der Schlauch um die Bahn ist { $tube } mm weit
error-cannot_follow = { $robot } kann dieser Bahn nicht folgen: { $reasons }

## Ablehnungen: Zahlen und Namen

error-start_out_of_reach = dort kann der Roboter nicht starten: Der Ort ist außer Reichweite oder zu nah an einer singulären Stellung
error-start_not_possible = so kann der Roboter nicht starten: { $reason }
error-no_such_joint = dieser Roboter hat kein solches Gelenk
error-set_by_process = das kann nur ändern, wer diesen Server betreibt
error-not_a_number = das ist keine Zahl
error-not_a_point = das ist kein Punkt
error-value_out_of_range = { $name }: { $value } liegt nicht zwischen { $low } und { $high }
error-value_not_a_number = { $name }: { $value } ist keine Zahl
error-decimal_comma = { $name }: schreibe { $point } statt { $value }
error-value_not_an_option = { $name }: { $value } ist keiner der Werte { $options }
error-unknown_name =
    { $kind ->
        [robot] unbekannter Roboter
        [path] unbekannte Bahn
        [experiment] unbekanntes Experiment
        [lesson] unbekannte Lektion
       [parameter] unbekannter Parameter
       *[other] unbekannter Name ({ $kind })
    } { $name }: { $hint }
error-law_does_not_suit = { $law } ist mit diesem Roboter nicht möglich: Es ist für eine andere Zahl von Motoren, Ausgängen oder Koordinaten gemacht
error-did_you_mean = meintest du { $names }?
error-there_are = es gibt { $names }
error-no_step = in dieser Lektion gibt es keinen Schritt { $step }: Sie hat { $steps ->
        [one] 1 Schritt
       *[other] { $steps } Schritte
    }

## Ablehnungen: ein eingetipptes Regelgesetz (models/control/laws)

error-no_translation = { $owner } verwendet CasADis Operation { $operation }, die sich nicht in { $target } übersetzen lässt
error-law_fails = { $law } ist hier nicht möglich: { $reason } ({ $file }, Zeile { $line })
error-law_of_file = { $law }: erwartet wird DATEI.py:NAME, etwa my_law.py:SlidingMode
error-law_no_file = es gibt keine Datei { $file }
error-law_same_name = OnPath hat ein Gesetz namens { $law }: wählen Sie einen anderen Namen
error-law_is_called = { $law } ist eine Python-Funktion, die in jedem Regelintervall aufgerufen wird. Das geht in onpath.simulate, onpath experiment und onpath arena; hier ist ein Gesetz ein Objekt mit command(view)
error-controller_profile = Ein Regler hat kein Geschwindigkeitsprofil: Setze stattdessen speed und ramp zwischen seinen Schritten
error-controller_paths = Die Bahnen eines Reglers sind alle geschlossen oder alle offen, und alle oder keine sind Zeichnungen
error-controller_differs = Dafür braucht es einen anderen Regler: Was sich geändert hat, ist in diesen einkompiliert
error-law_cannot_run = ein eigenes Gesetz ist mit diesem Roboter und diesen Einstellungen nicht möglich
error-no_earlier_settings = es gibt keine früheren Einstellungen, zu denen es zurückgehen könnte
error-too_many_actions = ein Verweis hat höchstens { $most } Aktionen
error-law = Zeile { $line }, Spalte { $column }: { $reason }
error-law_too_long = ein Regelgesetz hat höchstens { $most } Zeichen, nicht { $count }
error-law_too_complex = das Regelgesetz ist zu kompliziert: höchstens { $most } Namen, Zahlen und Operationen, höchstens { $deepest }-fach verschachtelt
error-law_character = { $character } bedeutet hier nichts
error-path_named = Bahn { $name }: { $reason }
error-law_no_text = ein Gesetz ist ein Name aus onpath.laws(), ein Text wie „across = -K1*xi - K2*dxi; along = 0“, DATEI.py:NAME, eine Funktion oder ein Objekt mit command(view), aber nichts vom Typ { $kind }
error-law_instead = schreibe { $instead } statt { $text }
error-law_not_a_number = { $text } ist keine Zahl; zwischen den Faktoren eines Produkts steht ein *
error-law_large_number = eine Zahl ist höchstens { $most }
error-law_unknown_name = { $name } gibt es nicht: { $hint }
error-law_without_target = eine Zeile beginnt mit einem von { $names }, dann folgt =
error-law_twice = für { $name } gibt es schon eine Zeile
error-law_without_line = es fehlt die Zeile, die mit { $name } = beginnt
error-law_mixed = ein Regelgesetz gibt entweder Beschleunigungen oder Drehmomente vor, nicht beides
error-law_unreadable = hier fehlt etwas, oder es steht am falschen Platz
error-law_not_finite = das ist keine endliche Zahl
error-law_function_alone = { $name } ist eine Funktion: Schreibe { $name }(…)
error-law_not_a_function = { $name } ist keine Funktion; zwischen den Faktoren eines Produkts steht ein *
error-law_arguments =
    { $count ->
        [one] { $name } nimmt einen Wert in den Klammern
       *[other] { $name } nimmt { $count } Werte oder mehr in den Klammern
    }
error-law_exponent = ein Exponent ist eine ganze Zahl von 0 bis { $most }
error-law_condition_alone = ein Vergleich steht nur in einer Bedingung: a if xi > 0 else b
error-law_not_a_condition = eine Bedingung vergleicht, etwa xi > 0

## Ablehnungen: Identifikation

error-nothing_recorded = es gibt noch nichts, woraus zu lernen wäre: Lass es erst ein paar Sekunden laufen
error-hardly_any_data = es gibt noch kaum Daten: Lass es erst ein paar Sekunden laufen
error-record_too_short = nur { $duration } s Daten: Lass es erst ein paar Sekunden laufen
error-hardly_moved = der Arm hat sich kaum bewegt: Lass ihn erst mit wechselndem Tempo einer Bahn folgen
error-motion_too_regular = die Bewegung war zu gleichmäßig, um die Parameter zu trennen: Ändere das Tempo, während es läuft, und versuche es noch einmal
error-not_identifiable = { $name } lässt sich aus dieser Bewegung nicht bestimmen ({ $value } ± { $error } kg m²): Lass ihn erst mit wechselndem Tempo einer Bahn folgen

## Ablehnungen: Vorhersagen

error-sketch_direction = zeichne eine Kurve von links nach rechts
error-sketch_without_points = eine Zeichnung braucht Punkte

## Ablehnungen: Tabellen in Dateien

error-table_long_line = Zeile { $line } ist länger als { $most } Zeichen
error-table_long = eine Tabelle hat höchstens { $most } Zeilen
error-table_separator = Zeile { $line }: { $text } trennt keine Spalten: das tun Komma, Semikolon oder Tabulator
error-table_quotes = Zeile { $line }: ein Anführungszeichen fehlt oder steht am falschen Ort
error-table_no_column = Zeile { $line }: es gibt keine Spalte { $name }
error-table_no_names = Zeile { $line }: die Spalten haben keine Namen, und { $name } ist keine ihrer Nummern, 1 bis { $last }: Sage, welche welche ist, etwa mit --column t=1 --column q1=2
error-array_file = die Felder lassen sich nicht lesen: { $reason }
error-table_column_twice = Zeile { $line }: es gibt mehrere Spalten { $name }
error-table_cells = Zeile { $line }: erwartet sind { $wanted } Zellen, nicht { $count }
error-table_empty = Zeile { $line }: nach den Namen der Spalten kommen keine Zeilen
error-table_not_a_number = Zeile { $line }, Spalte { $column }: { $text } ist keine Zahl
error-table_large_number = Zeile { $line }, Spalte { $column }: { $text } ist außerhalb des Bereichs
error-table_decimal_sign =
    Zeile { $line }, Spalte { $column }: { $text } passt nicht zu den Zahlen davor, die { $other ->
        [comma] ein Dezimalkomma
       *[point] einen Dezimalpunkt
    } haben; Ziffern lassen sich nicht gruppieren
error-record_of_another_robot = keine Aufzeichnung des Roboters { $robot }: { $reason }. Ist es die eines wirklichen Arms, so gib ihre Spalten an
error-in_file = Datei { $file }: { $reason }
error-record_without_laws = --law { $law }: { $file } hat keine Spalte law
error-no_motion_there = { $robot }: Um den Ort dieser Aufzeichnung kann er nicht schwingen, denn dort ist ein Anschlag
error-record_of_one_row = Zeile { $line }: eine einzelne Zeile eines Gesetzes ist keine Bewegung
error-record_times = Zeile { $line }, Spalte { $column }: Die Zeiten wachsen nicht von Zeile zu Zeile: Sie sind vielleicht gerundet; speichere die Datei mit mehr Stellen
error-record_coarse = Spalte { $column }: alle { $step } ms kommt eine Zeile, erlaubt sind höchstens { $most } ms dazwischen
error-no_links = { $robot } ist keine Kette von Gliedern, deren Massen sich trennen ließen: Was die Bewegung verrät, sind die gedruckten Parameter
error-log_columns = Gib an, in welchen Spalten diese Größen stehen: { $names }
error-log_factor = der Faktor von { $name } ist { $value }: er darf nicht 0 sein, und seine Größe muss von 1e-12 bis 1e12 gehen

## Bahnen aus Dateien (models/path_files)

say-raised = Der Stift wird { $count ->
    [one] einmal
    [2] zweimal
   *[other] { $count }-mal
} abgehoben: { $share } % der Zeit.
say-reordered = Die Linien werden in anderer Reihenfolge oder Richtung gezeichnet als in der Datei, damit der Stift kürzer abgehoben ist.
say-gcode_words = Diese Befehle der Datei haben keine Wirkung auf die Bahn: { $words }{ $more ->
    [0] .
   *[other] {""} und { $more } weitere.
}
say-gcode_layer = Die Datei druckt { $count } Schichten; gezeichnet wird Schicht { $layer }. Eine andere wählst du mit layer=2 und so weiter.
say-rounded = Die engste Biegung der Bahn hat einen Radius von { $radius } mm.
say-repeats = { $count ->
    [one] Eine Linie wiederholt eine andere und wird
   *[other] { $count } Linien wiederholen andere und werden
} einmal gezeichnet.
say-specks = { $count ->
    [one] Ein Fleck, kleiner als ein Fünfhundertstel der Zeichnung, wird
   *[other] { $count } Flecken, kleiner als ein Fünfhundertstel der Zeichnung, werden
} weggelassen.
say-svg_filled = { $count ->
    [one] Eine kleine gefüllte Form, etwa ein Buchstabe oder Punkt, wird
   *[other] { $count } kleine gefüllte Formen, etwa Buchstaben und Punkte, werden
} weggelassen. Mit einer Konturlinie werden sie gezeichnet.
say-svg_left_out = { $what ->
    [image] Bilder in der Zeichnung haben keine Linien und werden weggelassen. Nachgezeichnet hätten sie welche (in Inkscape: Pfad > Bitmap nachzeichnen).
   *[text] Text in der Zeichnung hat keine Linien und wird weggelassen. In Pfade umgewandelt hätte er welche (in Inkscape: Pfad > Objekt in Pfad umwandeln).
}
say-nearest = Der Bahn kann so nicht gefolgt werden: { $reasons }. Die Roboter folgen der nächstliegenden gefundenen, die möglich ist; sie ist bis zu { $apart } mm entfernt.
error-file_size = die Datei ist größer als { $most } MB
error-file_empty = die Datei ist leer
error-file_no_text = die Datei ist kein Text
error-file_described = die Datei beschreibt eine Bahn mit Worten; dazu gibt es keine Optionen
error-file_points = Zeile { $line }: mehr als { $most } Punkte
error-file_corners = die Linie hat zu viele Ecken: Höchstens { $most } werden abgerundet
error-file_no_line = die Datei enthält keine Linie, die eine Bahn sein könnte
error-file_part = part { $part }: die Datei hat { $count } Linien
error-file_layer = es gibt keine Ebene { $layer } mit Linien; die Ebenen sind { $names }
error-file_option = { $name }: { $value } ist nicht möglich
error-file_radius = ein Radius gehört zu corners=round
error-file_too_large = die Bahn reicht { $farthest } m weit vom Ursprung, möglich ist höchstens { $most } m: gib die Einheit an, einen Maßstab (scale) oder fit=0.1
error-file_takes_long = das Lesen der Datei hat zu lange gedauert
error-file_failed = die Datei konnte nicht gelesen werden
error-file_busy = eine Datei nach der anderen: Die letzte ist noch in Arbeit
error-file_incoherent = die Datei kam nicht so an, wie sie angekündigt war: Wähle sie noch einmal
error-file_late = die Datei war zu lange unterwegs: Wähle sie noch einmal
error-file_often = zu viele Dateien hintereinander: Warte einen Moment
error-points_columns = Zeile { $line }: { $count } Spalten, von denen keine x und y heißen
error-points_units = Zeile { $line }: x und y haben verschiedene Einheiten
error-gcode_word = Zeile { $line }, Spalte { $column }: { $text } wird nicht gelesen. Ein Wort ist ein Buchstabe und eine Zahl, etwa G1 oder X20.5; Maschinen mit anderen Achsen als X, Y und Z und Programme mit Variablen werden nicht gelesen
error-gcode_twice = Zeile { $line }, Spalte { $column }: { $text } sagt etwas, was die Zeile schon gesagt hat
error-gcode_both = Zeile { $line }: { $text } widersprechen einander
error-gcode_plane = Zeile { $line }: ein Bogen in einer anderen Ebene als der von X und Y ({ $text })
error-gcode_changes = Zeile { $line }, Spalte { $column }: { $text } { $why ->
    [radius] verschiebt die Bahn um den Radius des Werkzeugs
    [origin] verschiebt den Ursprung an einen Ort, den die Datei nicht nennt
    [turned] dehnt, dreht oder biegt die Bahn
    [program] ruft ein anderes Programm auf
    [curve] ist eine Kurve, die nicht gelesen wird
   *[unknown] ist nicht bekannt und könnte die Bahn ändern
}. Lass das Programm, das die Datei schrieb, einfache Bewegungen schreiben, G0 bis G3
error-gcode_no_arc = Zeile { $line }: I, J und R gehören zu den Bögen von G2 und G3
error-gcode_arc_form = Zeile { $line }: ein Bogen braucht entweder seinen Radius R oder I und J seines Mittelpunkts
error-gcode_arc_ends = Zeile { $line }: die Enden des Bogens sind { $first } mm und { $last } mm von seinem Mittelpunkt entfernt
error-gcode_radius = Zeile { $line }: kein Bogen mit dem Radius { $radius } mm hat diese Enden
error-signature = Strich { $stroke } der Unterschrift hat keine Punkte mit x und y, wie signature_pads toData() sie liefert
error-signature_json = Zeile { $line }, Spalte { $column }: kein JSON
error-svg_not_installed = Zeichnungen brauchen svgpathtools und tinycss2: pip install "onpath[svg]"
error-svg_no_drawing = die Datei ist keine SVG-Zeichnung
error-svg_no_xml = Zeile { $line }, Spalte { $column }: kein XML ({ $reason })
error-svg_entity = Zeile { $line }: die Entität { $name } steht nicht für bloßen Text und wird nicht gelesen
error-svg_grows = Zeile { $line }: Entitäten machen die Zeichnung viel länger als die Datei
error-svg_styles = Zeile { $line }: die Stilregeln der Zeichnung sind zu viele für ihre Elemente
error-svg_only = { $what ->
    [font] die Datei ist eine Schrift, keine Zeichnung: schreibe Text in ihr und wandle ihn in Pfade um (in Inkscape: Pfad > Objekt in Pfad umwandeln)
    [image] die Zeichnung ist ein Bild, das keine Linien hat: zeichne es nach (in Inkscape: Pfad > Bitmap nachzeichnen)
   *[text] die Zeichnung ist Text, der keine Linien hat: wandle ihn in Pfade um (in Inkscape: Pfad > Objekt in Pfad umwandeln; in Illustrator: Schrift > In Pfade umwandeln)
}
error-svg_large = Zeile { $line }: die Zeichnung hat mehr als { $most } Elemente, oder { $deepest } ineinander
error-svg_shape = Zeile { $line }: { $tag } ist hier nicht lesbar ({ $reason })

## Ablehnungen: Codes zum Teilen und Codes von Laboren

error-share_too_long = Dieser Text ist viel zu lang: Ein Code zum Teilen hat einige Hundert Zeichen.
error-share_missing = In diesem Text ist kein Code zum Teilen: Er beginnt mit ONPATH{ $version }-.
error-share_is_lab = Das ist der Code eines Labors, nicht der eines Aufbaus: Gib ihn bei „Anderer Code“ ein.
error-share_newer = Dieser Code stammt von einem neueren OnPath: Frage nach dieser Version.
error-share_incomplete = Dieser Code ist nicht vollständig: Kopiere ihn noch einmal, bis zum letzten Zeichen.
error-share_mistyped = Dieser Code ist vertippt oder abgeschnitten: Seine Prüfsumme passt nicht.
error-share_empty = Dieser Code enthält keinen Aufbau.
error-share_strange = Dieser Code enthält Dinge, die kein Labor hat.
error-share_does_not_fit = Dieser Code passt nicht zu diesem OnPath: { $error }.
error-no_such_lab = zu diesem Code gibt es kein Labor
error-word_too_short = Ein Wort hat mindestens { $least } Zeichen.
error-number_is_gone = diese Nummer zeigt kein Handy mehr; es hat inzwischen eine andere
error-lab_is_open = dieses Labor ist in einem anderen Fenster offen: Schließe erst jenes
error-lab_code_length = der Code eines Labors hat { $length } Buchstaben und Ziffern, wie { $example }
error-lab_code_letters = das ist kein Code eines Labors: 0, 1, i, l und o kommen in keinem vor; einer sieht aus wie { $example }

## Ablehnungen: was in einer Datenbank gespeichert wird (app/storage)

error-database = die Datenbank meldet: { $reason }
error-database_at = { $place } ist nicht zu gebrauchen: { $reason }
error-database_keeps_breaking = die Datenbank wird immer wieder beschädigt
error-database_busy = die Datenbank ist beschäftigt
error-database_table = ihre Tabelle { $table } gehört nicht zu OnPath
error-database_tables_newer = ihre Tabellen ({ $revision }) stammen von einem neueren OnPath, das hier nötig ist
error-database_newer = sie hat die Version { $version } und stammt von einem neueren OnPath, das hier nötig ist
error-lab_newer = dieses Labor hat ein neueres OnPath gespeichert
error-lab_unreadable = was von diesem Labor gespeichert ist, lässt sich nicht lesen
error-not_storable = das kann nicht gespeichert werden: { $reason }
error-too_much_to_store = das ist zu viel, um gespeichert zu werden: { $size } MB, höchstens { $most } MB
say-robots_of_then = Dieses Labor wurde mit Robotern aus Dateien gespeichert, die dieser Server nicht hat: { $names }. Es läuft ohne sie weiter; mit --robot und der Datei sind sie wieder da.
say-laws_of_then = Dieses OnPath hat diese Gesetze oder Verstärkungen nicht, die mit diesem Labor gespeichert wurden: { $names }. Es läuft ohne sie weiter.
say-path_of_then = Die Bahn, die mit diesem Labor gespeichert wurde, wird heute abgelehnt: { $reasons }. An ihrer Stelle steht der Kreis.
say-lab_kept = Dein Labor ist gespeichert, lässt sich aber gerade nicht öffnen: { $reason }

## Ablehnungen: die Klasse

error-too_many_codes = zu viele falsche Codes: Warte eine Minute
error-hurry = eins nach dem anderen: Versuche es gleich noch einmal
error-not_the_key = das ist nicht der Schlüssel der Lehrkraft
error-not_the_class_code = das ist nicht der Klassencode auf der Leinwand; vergleiche auch die Adresse dieser Seite
error-class_full = diese Klasse ist voll
error-no_nickname = ein Spitzname hat mindestens ein Zeichen

## Ein Formular: assets/web/parts/form.ts

form-back = Zurück auf { $value }, die Vorgabe
form-back_lesson = Zurück auf { $value }, wie in diesem Schritt
form-back_group = Zurücksetzen: { $group }
form-changed = geändert
form-count_on = { $count } an
form-is_on = an
form-off = aus
form-no_number = Das ist keine Zahl. Möglich ist { $low } bis { $high }.
form-range = Möglich ist { $low } bis { $high }.
form-differs = { $value } wurde nicht übernommen.
form-poles = Die Pole der Gesetze in der komplexen Ebene. Links der Achse klingt eine Bewegung ab, rechts von ihr wächst sie an.
form-use = Verwenden
form-group_setup = Aufbau
form-group_hand = Hand und Störungen
form-group_gains = Verstärkungen und Bahn
form-group_view = Ansicht
form-group_robot = Dieser Roboter
form-section_motors = Motoren
form-section_sensors = Sensoren
form-section_friction = Reibung
form-section_computer = Rechner
form-section_load = Last
form-section_motion = Bewegung längs der Bahn
form-section_points = Kontrollpunkte
form-section_model = Fehler des Modells

## Eine Abbildung ohne Server

standalone-path = Bahn
standalone-hint_hold_pull =
    { $robots ->
        [one] Den Roboter festhalten oder an seiner Spitze ziehen.
       *[other] Beide Roboter festhalten oder an einer Spitze ziehen und vergleichen.
    } Wer an der Linie unten zieht, blickt zurück.
standalone-hint_hold =
    { $robots ->
        [one] Den Roboter festhalten.
       *[other] Die Roboter festhalten und vergleichen.
    } Wer an der Linie unten zieht, blickt zurück.
standalone-hint_pull = Mit der Maus oder einem Finger an einer Spitze ziehen. Wer an der Linie unten zieht, blickt zurück.
# Die Teile, in der Reihenfolge des Laufs: standalone-recorded_start und so weiter
standalone-hint_raised = Wo die Bahn gestrichelt ist, ist der Stift angehoben.
standalone-recorded = Im aufgezeichneten Lauf, aber nicht auf dieser Seite: { $parts }.
standalone-recorded_start = ein anderer Start
standalone-recorded_profile = ein Tempo-Verlauf
standalone-recorded_reverse = eine Umkehr
standalone-recorded_hold = ein Festhalten
standalone-recorded_push = eine ziehende Hand
standalone-recorded_wall = eine Wand
standalone-scene = Der Roboter unter dem Gesetz { $law }, von der Seite gezeichnet
standalone-law = Gesetz
standalone-late = Die Zeit hinkt nach: Das Gerät ist zu langsam.
standalone-coincide = zwei Kontrollpunkte würden zusammenfallen
standalone-selected = Kontrollpunkt { $number } von { $all } ist gewählt: Mit den Pfeiltasten wird er bewegt.
standalone-drag_hint = Die Punkte der Bahn lassen sich ziehen; die Taste N wählt den nächsten, und die Pfeiltasten bewegen ihn.
standalone-no_script = Diese Abbildung braucht JavaScript, das hier ausgeschaltet oder von der Content-Security-Policy des Servers verboten ist.
standalone-only_picture = Ein Bild des Aufgezeichneten. Die Roboter bewegen sich hier nicht: { $reason }
standalone-still = Die Roboter in ihrem größten Abstand von der Bahn und der Abstand über der Zeit: { $laws }
standalone-still_robot =
    { $law }
    bis zu { $far } mm von der Bahn
standalone-refused = Diese Abbildung läuft hier nicht: Sie braucht WebAssembly. Wenn der Browser es hat, verbietet es der Server: Seine Content-Security-Policy muss dann 'wasm-unsafe-eval' in script-src erlauben. ({ $reason })
standalone-description = Eine Simulation, die in dieser Seite läuft: { $laws }
standalone-about = { $product }, MIT-Lizenz. Die Theorie: Hladio, Nielsen, Wang: „Path following for mechanical systems: experiments and examples“.

# Das Schaubild der Abstände, die Lupe und die Knöpfe für die Zeit

chart-title = Abstand von der Bahn
chart-held = festgehalten
chart-pulled = gezogen
chart-centre = Mittelpunkt des Kreises
chart-table = Als Tabelle
chart-time = Zeit [s]
chart-acts = festgehalten oder gezogen
chart-look = Zurückblicken
chart-look_hint = Ziehen, um über die letzte Minute zurückzublicken; mit Tasten: Pfeile, Bild auf und ab, Pos1 und Ende
chart-at = { $time } s: { $values }
chart-yours = Deine Vorhersage
chart-first = Deine erste Kurve
chart-log = Messung
chart-remove_log = Messung entfernen
chart-draw = Hier zeichnen, von links nach rechts
chart-pending = „Geschehen lassen“ zeichnet hier
chart-point = Deine Vorhersage bei { $time } s
lens-name = Die Spitze unter dem Gesetz { $law }, vergrößert
lens-closest = nächster Bahnpunkt
lens-reference = Sollpunkt
lens-straight = gerades Glied
transport-back = Zurück zu jetzt
transport-back_hint = Zeigt wieder die Gegenwart. Taste: Ende, auf dem Griff
transport-go_on_hint = Verwirft, was danach kam. Taste: G

## Der Kurs als statische Seiten: assets/web, app/exports/site

symbol-lambda = Abstand von der Bahn, mit Vorzeichen
symbol-xi_1 = Abstand quer zur Bahn, mit Vorzeichen
symbol-theta = Stelle des nächsten Punktes auf der Bahn
symbol-theta_r = Stelle des Punktes der Uhr auf der Bahn
symbol-e = Folgefehler: vom Punkt der Uhr zur Spitze
symbol-d = Abstand von der Bahn
symbol-y = Lage der Spitze
symbol-sigma = die Bahn
symbol-N = Einheitsnormale der Bahn
symbol-T = Einheitstangente der Bahn
symbol-F = Kraft auf die Spitze
symbol-q_1 = Winkel von Glied 1
symbol-q_2 = Winkel von Glied 2
symbol-delta = Winkel am Ellbogen
symbol-rho = Abstand der Spitze vom Fuß
symbol-K_1 = Feder quer zur Bahn oder zum Punkt der Uhr
symbol-K_2 = Dämpfer, der zu K1 gehört
symbol-K_3 = Integral: zählt den Fehler über die Zeit zusammen
symbol-K_4 = Feder längs der Bahn
symbol-K_5 = Dämpfer längs der Bahn: hält das gewünschte Tempo
site-symbols = Zeichen auf dieser Seite
site-title = OnPath: Bahnfolgeregelung ist nicht Trajektorienfolgeregelung
site-intro = Zwei Roboter zeichnen dieselbe Bahn. Einer folgt einem Fahrplan, der andere einer Kurve: Sieh, was geschieht, wenn man sie festhält. Im Kurs sagst du vorher, probierst, siehst und verstehst; alles läuft auf dieser Seite.
lecture-notes = Notizen
lecture-open = Ein Vortrag von 20 Minuten, mit Notizen
site-lab = Probiere es aus
site-skip = Zum Text
site-only_lab = Nur im Labor: { $what }.
site-run_only_lab = Dieser Lauf lässt sich nur im Labor abspielen. Das Bild zeigt ihn.
site-task_only_lab = Diese Aufgabe lässt sich nur im Labor lösen; dort gibt es, was ihre Lösung braucht.
site-link_only_lab = nur im Labor
site-picture = Was geschieht, { $quantity } [{ $unit }] über { $seconds } s. Die größten Werte: { $peaks }.
site-answers = Antworten
site-hint = Hinweis { $number }
site-recipe = Hinweis { $number }: das Rezept (die Aufgabe gilt dann als gezeigt, nicht als gelöst)
site-why = Warum hat das geklappt? Finde einen Grund, dann öffne
site-progress = Dein Fortschritt
site-kept = Dein Fortschritt wird nur in diesem Browser gespeichert. Sichere ihn als Datei, um anderswo weiterzumachen.
site-save = Als Datei sichern
site-read = Datei lesen
site-forget = Löschen
site-forget_sure = Allen Fortschritt löschen, der in diesem Browser gespeichert ist?
site-forgotten = Gelöscht.
site-read_done = Gelesen.
site-no_progress = Diese Datei enthält keinen Fortschritt in diesem Kurs.
site-not_kept = Dieser Browser speichert für diese Seite nichts. Dein Fortschritt bleibt, bis du sie schließt.
site-skipped = Du hast die Vorhersage übersprungen. Hier kannst du sie noch machen.
site-draw_first = Zeichne mit der Maus oder dem Finger in das Diagramm, von links nach rechts.
site-draw_keys = Mit Tasten: Tab führt zu seinen Punkten; die Pfeile nach links und rechts wählen einen, die nach oben und unten bewegen ihn.
site-commit_short = Festlegen
site-skip_short = Überspringen
site-again = Die Kurven dieses Laufs sind nicht gespeichert: Lass ihn noch einmal geschehen, um sie zu sehen.
site-no_platform = Um diese Seite wurde keine Lernplattform gefunden. Dein Fortschritt wird nur in diesem Browser gespeichert.
site-refused = Die Lernplattform hat deinen Fortschritt nicht angenommen: { $reason }. Was nicht gespeichert ist, geht verloren, wenn du diese Seite schließt.
site-no_room = Die Lernplattform hat keinen Platz für mehr von deinem Fortschritt: Was du jetzt tust, geht verloren, wenn du diese Seite schließt.
site-cut = Die Lernplattform speichert höchstens { $most } Zeichen einer Lektion: von deinen längsten Texten nur den Anfang. Sichere eine Kopie, wenn du sie ganz brauchst.
site-review = Die Lernplattform hat diese Lektion zum Ansehen geöffnet: Nichts von dem, was du jetzt tust, wird gespeichert.
site-sketch = Tafel zum Zeichnen: { $quantity } [{ $unit }] von 0 bis { $seconds } s. Mit der Maus oder dem Finger, von links nach rechts; oder mit Tasten, an seinen Punkten.
site-done = { $done } von { $all } Schritten gesehen, { $tasks } Aufgaben gelöst
site-next_lesson = Nächste Lektion: { $title }
site-end = Das Ende dieser Lektion
site-features = Was diese Seiten nicht haben
site-features_text = Diese Seiten haben keinen Bahneditor, kein eigenes Gesetz, keinen anderen Roboter und kein anderes Gesetz im selben Schritt, kein Diagramm außer dem des Abstands, keine Wand, keinen Start neben der Bahn, keine Identifikation, keine Klasse, keinen Konzepttest und kein CSV. Wo eine Lektion etwas davon benutzt, sagt sie es. Das Labor hat all das.
site-control-gains = alle Verstärkungen und der Realismus
site-control-plots = die anderen Diagramme
site-control-past = das Zurückblicken
site-control-robot = die Wahl des Roboters
site-control-laws = die Wahl des Gesetzes
site-control-identify = die Identifikation
site-why-identify = sie braucht Aufzeichnungen jeder Millisekunde und die Statistik der Schätzwerte
site-control-wall = die Wand
site-control-sign = das Unterschreiben mit den Robotern
site-why-sign = auf der Seite kann man nicht schreiben
site-control-path = die Wahl der Bahn

## Roboter aus Dateien

robot_file-at = { $file }, Zeile { $line }, { $element }: { $reason }
robot_file-at_line = { $file }, Zeile { $line }: { $reason }
robot_file-absent = { $file }: Diese Datei gibt es nicht
robot_file-unreadable = { $file } lässt sich nicht lesen: { $reason }
robot_file-size = { $file } ist größer als { $most }
robot_file-elements = mehr als { $most } Elemente oder mehr als { $deepest } ineinander
robot_file-doctype = ein Dokumenttyp wird nicht angenommen, weil er Entities definieren kann: Löschen Sie ihn
robot_file-xml = das ist kein XML: { $reason }
robot_file-root = die Datei eines Roboters beginnt mit <robot> (URDF) oder <mujoco> (MJCF)
robot_file-xacro = das ist eine xacro-Datei: Ihr Name muss mit .xacro enden, und xacro installiert sein: pip install "onpath[xacro]"
robot_file-without = { $what } fehlt
robot_file-numbers = { $field } { $value }: erwartet { $count ->
    [one] wird eine Zahl
   *[other] werden { $count } Zahlen
 }
robot_file-large = { $field } { $value }: erwartet werden endliche Zahlen bis 1e9
robot_file-no_link = ein Glied { $name } gibt es nicht
robot_file-two_parents = das Glied { $name } hängt schon am Gelenk { $other }
robot_file-loop = die Glieder bilden eine Schleife: Nur Bäume aus Gliedern lassen sich simulieren
robot_file-apart = kein Gelenk führt von { $name } hierher: Alle Glieder eines Roboters hängen zusammen
robot_file-twice = den Namen gibt es schon in Zeile { $line }
robot_file-many = mehr als { $most } davon
robot_file-type = unbekannter Typ { $type }
robot_file-outside = { $value } liegt außerhalb der Grenzen von { $low } bis { $high }
robot_file-mass = die Masse { $value } ist negativ
robot_file-negative = { $field } ist negativ
robot_file-limits = die untere Grenze { $low } liegt über der oberen { $high }
robot_file-axis = eine Achse braucht eine Richtung
robot_file-no_joints = in dieser Datei bewegt sich kein Gelenk: Sie beschreibt einen starren Körper, etwa eine Drohne ohne Arm, und nichts darin kann einer Bahn folgen
robot_file-hand = in dieser Datei bewegen sich nur Finger: Sie beschreibt eine Hand oder einen Greifer. Laden Sie den Arm dazu, oder nennen Sie das Ende eines Fingers mit --tip (in Python tip=…)
robot_file-still_tip = die Spitze bewegt sich nicht: Kein Gelenk auf dem Weg zu ihr tut es
robot_file-no_tip = ein Glied { $tip } gibt es nicht, aber { $names }
robot_file-no_joint = ein Gelenk { $joint } gibt es nicht, aber { $names }
robot_file-pose = { $joint }: { $value } ist keine Stellung
robot_file-pose_outside = { $joint }: { $value } liegt nicht zwischen den Grenzen { $low } und { $high }
robot_file-armature = ein Läufer-Trägheitsmoment von { $value } kg m²: erwartet wird 0 bis { $most }
robot_file-no_pose = die Spitze lässt sich aus keiner Stellung in alle Richtungen bewegen: Ihre Gelenke drehen sie um einen Punkt oder um parallele Achsen. Nennen Sie ein anderes Glied mit --tip (in Python tip=…)
robot_file-no_pose_package = die Spitze lässt sich aus keiner Stellung in alle Richtungen bewegen: Ihre Gelenke drehen sie um einen Punkt oder um parallele Achsen. Vielleicht liegt sie am äußersten Ende ihres Glieds, aber für das Netz, das es zeigen würde, fehlt ein Paket: { $lines }. Oder nennen Sie ein anderes Glied mit --tip (in Python tip=…)
robot_file-singular = aus dieser Stellung kann sich die Spitze nicht in alle Richtungen bewegen: Geben Sie eine andere mit --pose (in Python pose=…) an
robot_file-circle = Kreise bis { $circle } mm sind möglich, Bahnen brauchen aber { $least } mm: Geben Sie mit --pose eine andere Stellung oder mit --tip ein anderes Glied an (in Python pose=… und tip=…)
robot_file-single = nur ein Gelenk bewegt die Spitze, wie bei einem Rad, einem Rotor oder einem Greifer: Das ist kein Arm oder Bein, die mindestens zwei haben. Hat die Datei so etwas, nennen Sie sein Ende mit --tip (in Python tip=…)
robot_file-two_across = zwei Gelenke bewegen die Spitze, aber nicht in einer Ebene, wie bei einer Kamerahalterung: Sie kann keiner Bahn folgen. Hat die Datei einen Arm oder ein Bein, nennen Sie dessen Ende mit --tip (in Python tip=…)
robot_file-guessed_pose = die Datei nennt keine Stellung: gewählt wird eine, in der sich die Spitze leicht in alle Richtungen bewegt
robot_file-guessed_pose_floor = die Datei nennt keine Stellung: gewählt wird eine, in der sich die Spitze leicht in alle Richtungen bewegt. Gelenke sind unter dem Boden, weil es darüber keine gute Stellung gibt
robot_file-guessed_pose_ahead = die Datei nennt keine Stellung: gewählt wird eine, in der sich die Spitze leicht in alle Richtungen bewegt. Sie ist hinter der Basis, weil es davor keine gute Stellung gibt
robot_file-guessed_pose_floor_ahead = die Datei nennt keine Stellung: gewählt wird eine, in der sich die Spitze leicht in alle Richtungen bewegt. Gelenke sind unter dem Boden und die Spitze ist hinter der Basis, weil es keine andere gute Stellung gibt
robot_file-guessed_efforts = die Datei sagt nicht, was die Motoren leisten: Sie sind unbegrenzt
robot_file-guessed_effort = die Datei sagt nicht, was die Motoren von { $joints } leisten: Sie sind unbegrenzt
robot_file-guessed_armature = mit den Massen der Datei hielte Reibung ein Gelenk in Bruchteilen einer Millisekunde an, oder ein Gelenk bewegt nichts Schweres: Eine Trägheit der Motoren von { $armature } kg m² kommt hinzu
robot_file-massless = was das Gelenk { $joint } bewegt, hat keine Masse oder Trägheit: Geben Sie mit --armature (in Python armature=…) die Trägheit der Motoren an
robot_file-mujoco = eine MJCF-Datei braucht MuJoCo: pip install "onpath[mujoco]"
robot_file-mjcf = MuJoCo kann { $file } nicht lesen: { $reason }
robot_file-mujoco_slow = MuJoCo wurde beim Lesen von { $file } beendet: Es brauchte mehr als { $seconds } s
robot_file-mujoco_ended = MuJoCo ist beim Lesen von { $file } ausgefallen: Es ist abgestürzt oder brauchte zu viel Speicher
robot_file-mujoco_warns = MuJoCo warnt: { $reason }
robot_file-same_name = { $name } heißt schon ein anderer Roboter
robot_file-absent_robot = diese Einstellung ist für den Roboter { $name } aus einer Datei: Starten Sie das Labor mit { $line } und mit den Optionen, mit denen es dort gestartet wurde
robot_file-and_more = { $names } und { $more } weitere
robot_file-still = Gelenke ohne Weg zwischen ihren Grenzen bleiben stehen: { $names }
robot_file-not_drawn = nicht gezeichnet, weil es im Ordner oder Paket des Roboters keine solche .stl-, .obj-, .dae- (URDF) oder .msh-Datei (MJCF) bis 20 MB gibt oder die Größe fehlt: { $names }
robot_file-guessed_package = Netze liegen im Paket { $package }, das nicht bekannt ist
robot_file-guessed_mass = die Datei nennt für manche Körper keine Masse: Sie gelten als Körper mit { $density } kg/m³, zusammen { $mass } kg: { $names }
robot_file-guessed_mass_without = die Datei nennt für manche Körper keine Masse, und ein Paket, das ihre Netze liest, ist nicht installiert: Sie gelten als Körper mit { $density } kg/m³, zusammen { $mass } kg: { $names }
robot_file-guessed_inertia = die Datei nennt Massen, aber ihre Trägheit nicht: Sie gelten als volle Körper: { $names }
robot_file-repaired = die Trägheit in der Datei kann kein Körper haben, weil ein Hauptträgheitsmoment die Summe der anderen übersteigt; genommen wird die nächste: { $names }
robot_file-mass_stated = eine Masse von { $mass } kg ist weniger, als die Datei für manche Körper nennt, { $stated } kg: Geben Sie mit --mass (in Python mass=…) mehr an
robot_file-density_range = eine Dichte von { $value } kg/m³: erwartet wird mehr als 0, bis { $most }
robot_file-mass_range = eine Masse von { $value } kg: erwartet wird mehr als 0, bis { $most }
robot_file-shape = eine Form braucht eine Größe, und ein Netz eine Datei
robot_file-no_xacro = { $file } ist eine xacro-Datei, und die braucht xacro: pip install "onpath[xacro]"
robot_file-xacro_ended = xacro wurde beim Auswerten von { $file } beendet: Es brauchte zu lange oder zu viel Speicher
robot_file-xacro_refused = xacro kann { $file } nicht auswerten: { $reason }
robot_file-xacro_package = { $file } braucht das Paket { $package }, das weder bei der Datei liegt noch angegeben ist: { $line }
robot_file-xacro_argument = { $file } verlangt ein Argument und gibt ihm keinen Wert: Schreiben Sie <xacro:arg name="{ $name }" default="…"/> unter <robot>, mit dem gewünschten Wert
robot_file-xacro_ran = { $file } ist ein Programm: xacro hat seine Ausdrücke ausgeführt, in einem Prozess mit Grenzen
robot_file-include = { $file } lässt sich nicht einbinden: Es ist keine .xml-Datei im Ordner oder Paket des Roboters (--package NAME=ORDNER; in Python packages=…), oder sie wird zweimal eingebunden
robot_file-guessed_tip = die Datei sagt nicht, welches Glied die Spitze ist: genommen wird { $tip }
robot_file-guessed_end = die Datei hat kein Glied am Ende von { $tip }, dessen Ursprung nur die Gelenke davor bewegen: Die Spitze ist sein äußerstes Ende, in seinem Koordinatensystem bei { $place } m. Ein Glied mit festem Gelenk an dieser Stelle würde es sagen
robot_file-unread_end = die Datei hat kein Glied am Ende von { $tip }, und ein Paket, das sein Netz liest, ist nicht installiert: Die Spitze bleibt an seinem Ursprung, den nur die Gelenke davor bewegen
robot_file-guessed_free = schwebende, ebene und Kugelgelenke bleiben, wo sie sind: { $names }
robot_file-guessed_mimic = Gelenke, die einem anderen folgen, bleiben, wo sie sind: { $names }
robot_file-guessed_many = höchstens 8 Gelenke können sich auf dem Weg zur Spitze bewegen; diese bleiben, wo sie sind: { $names }
robot_file-guessed_off = Gelenke abseits des Wegs zur Spitze bleiben, wo sie sind: { $names }
robot_file-guessed_limits = Gelenke, für die die Datei keine Grenzen nennt oder beide mit 0, gelten als unbegrenzt: { $names }
robot_file-mesh_unreadable = das Netz { $mesh } wird weggelassen: { $reason }
robot_file-refused = <{ $element }> wird nicht gelesen, weil es andere Dateien lesen, Code ausführen oder aus einem Element viele machen kann: Lassen Sie es weg, oder laden Sie die Datei in MuJoCo und speichern Sie sie mit einfachen Elementen
robot_file-unknown = in <{ $parent }> gibt es kein solches Element
robot_file-meshes = die Netze haben mehr als { $most }
robot_file-left_out = weggelassen: { $parts }

## Die Arena (app/exports/arena_page.py)

arena-title = Die Arena
arena-made = OnPath · { $done ->
        [one] 1 Versuch
       *[other] { $done } Versuche
    } von { $planned } · { $command }
arena-about = Wie gut hält ein Regelgesetz einen Roboter auf seiner Bahn, wenn etwas im Weg ist? Jede Tabelle gilt für einen Roboter und hat eine Zeile für jedes Gesetz und eine Spalte für jede gemessene Größe; was sie bedeuten, steht unter den Tabellen.
arena-same = Jedes Gesetz durchläuft dieselben Versuche: Roboter, Bahn, Hindernis und Bedingung, Verstärkungen, Modell, Motoren, Drehmomentgrenze und Zufallszahlen sind gleich. Die Drehmomentgrenze ist das 1,5-Fache dessen, was die ungestörte Bahnfolgeregelung auf dieser Bahn braucht, bei schwachen Motoren das 0,9-Fache, und bei einem Roboter aus einer Datei nie mehr, als die Datei angibt, in % davon. Jedes Gesetz verwendet die Verstärkungen K1 bis K5, die in seiner Formel vorkommen, und seine eigenen. Versuche und eigene Verstärkungen sind unten aufgeführt.
arena-rows = Die meisten Gesetze haben zwei Zeilen. Sie unterscheiden sich darin, was geschieht, wenn ein Motor mehr als seine Drehmomentgrenze bräuchte. „Gekappt“: Das Drehmoment bleibt an der Grenze. „Quer zuerst“: Ein Mittel, das zu keinem Gesetz gehört, verzichtet auf Beschleunigung entlang der Bahn, bevor es auf die quer dazu verzichtet. Ein Gesetz, das selbst Drehmomente vorgibt, kann nur gekappt werden.
arena-numbers = In jedem Feld steht der schlechteste Wert aller Versuche, die einen ergeben, und klein ihr Median. Der schlechteste Wert ist ein Link zu seinem Lauf. Die Zahl im Kreis ist der Rang in dieser Größe unter den Zeilen desselben Roboters, ab 1, dem besten; gleiche Werte haben denselben Rang. Ein Gesetz mit einem abgebrochenen Lauf steht hinter allen ohne einen. Es gibt keine Gesamtnote: Worauf es ankommt, entscheiden Sie.
arena-settings = Für alle Gesetze gleich: gewünschte Geschwindigkeit { $speed } rad/s, eine Runde dauert also { $lap } s; { $gains }; Regelung mit { $rate } Hz, wenn ein Versuch nichts anderes sagt.
arena-gains = eigene Verstärkungen: { $gains }
arena-measures = Was gemessen wird
arena-force_N = Kraft bis zum Verlassen der Bahn
arena-force_N_text = Eine Hand geht mit dem Endpunkt mit und zieht ihn quer zur Bahn, mit einer Kraft, die jede Sekunde um 2 N bis auf 10 N wächst. Dies ist die Kraft, bei der der Endpunkt erstmals 5 mm von der Bahn entfernt ist. „Nicht bis 10 N“: Er ist es nie; 0,00: Er war es, bevor die Hand zog. Was bei stärkerem Zug geschieht, zählt nicht. Ein Gesetz mit großer Kraft gibt wenig nach; für einen Roboter, der nachgeben soll, ist das kein Vorteil.
arena-distance_m = Abstand
arena-distance_m_text = Der größte Abstand des Endpunkts von der Bahn während eines Versuchs, in allen Versuchen außer dem Zug.
arena-delay_s = Verspätung
arena-delay_s_text = Wie spät der Endpunkt am Ende eines Versuchs ist, verglichen mit einem Punkt, der immer mit der gewünschten Geschwindigkeit läuft; negativ: zu früh. Der Rang richtet sich nach dem Betrag. Ein Gesetz ohne Uhr ist mit Absicht etwa so lange verspätet, wie es festgehalten wurde. Runden werden am nächsten Bahnpunkt gezählt: Ein Endpunkt, der innen abkürzt, kann eine Runde verlieren und ist dann um deren Dauer verspätet.
arena-energy_J = Energie an die Hand
arena-energy_J_text = Die größte Arbeit, die der Endpunkt bis zu irgendeinem Zeitpunkt beim Ziehen, beim Festhalten oder an der Wand verrichtet hat, in den Versuchen, in denen es das gibt. Wer den Roboter hält, spürt sie als Stoß.
arena-overshoot_m = Überschwingen nach dem Loslassen
arena-overshoot_m_text = Wie weit der Endpunkt die Bahn wieder verlässt, nachdem ihn Hand, Halt oder Wand losgelassen haben, gezählt ab dem Augenblick, in dem er bis auf 5 mm an der Bahn ist und nicht mehr näher kommt. „Nicht zurück“: Er kommt bis zum Ende des Versuchs nicht auf 5 mm heran.
arena-stops = Abbrüche
arena-stops_text = Läufe, die beendet wurden, weil die Bewegung divergierte oder das Gesetz versagte, von allen Läufen dieser Zeile. Sie haben keine anderen Zahlen. Die ersten drei sind verlinkt.
arena-of = { $stops } von { $runs }
arena-law = Gesetz
arena-limit = an der Drehmomentgrenze
arena-cut = gekappt
arena-remedy = quer zuerst
arena-torques = gekappt, gibt Drehmomente vor
arena-median = Median { $value }
arena-better_larger = größer ist besser
arena-better_smaller = kleiner ist besser
arena-better_near_zero = nahe 0 ist besser
arena-rank = Rang { $rank } von { $of }
arena-never = nicht bis 10 N
arena-not_back = nicht zurück
arena-own = Ihres
arena-trials = { $count ->
        [one] 1 Versuch
       *[other] { $count } Versuche
    }
arena-obstructions = Die Versuche
arena-trial = Versuch
arena-robot = Roboter
arena-path = Bahn
arena-obstruction = Hindernis
arena-condition = Bedingung
arena-torque_limit = Drehmomentgrenze
arena-sized = { $path }, { $width } × { $height } mm
arena-pull = wachsender Zug quer zur Bahn, ab { $begin } s
arena-brake = längs der Bahn festgehalten, { $begin } bis { $end } s
arena-hand = eine Hand, die an einen Ort { $away } mm neben der Bahn zieht, { $begin } bis { $end } s
arena-wall = eine Wand quer zur Bahn, { $begin } bis { $end } s
arena-weak = schwache Motoren
arena-exact = Modell und Sensoren genau
arena-payload = eine Nutzlast von { $payload } kg, die kein Gesetz kennt
arena-noise = Messrauschen { $sensor_noise } rad, Drehgeber mit { $encoder_counts } Schritten je Umdrehung
arena-slow = Regelung mit { $control_rate } Hz
arena-runs = Die Läufe hinter den Zahlen
arena-run = { $obstruction }; { $path }, { $condition } (Versuch { $number }, { $robot })
arena-picture = Links: der Abstand von der Bahn über der Zeit; grau hinterlegt: solange das Hindernis wirkt; gestrichelt: 5 mm. Rechts: die Bahn, grau, und die Linie, die der Endpunkt zeichnet.
arena-scale = Links: 0 bis { $lasts } s und 0 bis { $most } mm.
arena-recorded = Der Punkt bewegt sich wie aufgezeichnet.
arena-figure = Dieses Gesetz an diesem Roboter ausprobieren: eine lebende Abbildung
arena-repeat = Derselbe Lauf:
arena-stopped = abgebrochen bei { $time } s: { $reason }
arena-laws = Die Gesetze
arena-interrupted = unterbrochen: { $html } enthält die Versuche, die alle Gesetze beendet haben
arena-nothing = unterbrochen, bevor alle Gesetze einen Versuch beendet hatten
arena-first = erste Tabelle, nach { $seconds } s
arena-written = geschrieben: { $html } und { $csv }

## Was um die Bühne herum steht: Kopf, Suche, Hilfe, Blätter

question-yes = Ja
question-no = Nein
panel-handle = Einstellungen: halbe oder ganze Höhe
head-more = Mehr
search-title = Suche
search-hint = Einstellung, Roboter, Regelung, Bahn, Lektion oder Taste
search-found = Gefunden
search-none = Nichts gefunden. Versuche ein anderes Wort.
search-kind_open = Öffnen
search-kind_robot = Roboter
search-kind_law = Regelung
search-kind_path = Bahn
search-kind_lesson = Lektion
search-kind_key = Taste
search-of_robots = Alle Roboter mit ihren Bildern
search-of_laws = Was jede Regelung tut, und wie man eine eigene eingibt
search-of_compare = Dasselbe Hindernis für mehrere Regelungen, mit Kurven und Tabelle
search-of_keep = Codes, Teilen, Export, Tabelle, Bild, Aufnahme, Bericht über Lektionen
search-of_lessons = Alle Lektionen und Routen, und wie weit du bist
search-of_help = Was ist was, Tasten, Glossar
search-of_log = Was ein wirklicher Arm aufgezeichnet hat, über den Verläufen
search-of_file = Eine Bahn aus einer Punkttabelle, einer Zeichnung oder G-Code
search-of_class = Dein Spitzname, was von dir gespeichert wird, beitreten oder verlassen
search-of_teach = Die Seite der Lehrkraft, mit ihrem Schlüssel
search-of_display = Sprache, Aussehen: hell oder dunkel, große Schrift, Ansagen, Ton
look-title = Aussehen
look-system = wie das System
look-light = hell
look-dark = dunkel
help-point = Auf der Seite zeigen, was was ist
help-keys = Alle Tasten
help-own_keys = Ein Bedienelement mit dem Fokus bekommt seine eigenen Tasten zuerst: ein Schieber die Pfeile, ein Knopf die Leertaste.
keys-time = Zeit
keys-hand = Hand
keys-path = Bahn
keys-wall = Wand
keys-rest = Sonstiges
aid-hold = Beide festhalten
aid-hold_means = hält beide Spitzen an. Den Nachläufer reißt seine Uhr fort; der Bahnfolger wartet.
aid-pull = Spitze ziehen
aid-pull_means = Mit der Maus oder einem Finger ziehst du den Roboter von seiner Bahn.
aid-bend = Graue Kugel ziehen
aid-bend_means = verbiegt die Bahn, während die Roboter fahren.
aid-aim = Ring oder Punkt
aid-aim_means = worauf die Regelung zielt: Ein Ring läuft nach der Uhr, ein Punkt ist der nächste Punkt der Bahn.
aid-lens = Lupe
aid-lens_means = die Spitze, vergrößert um die Zahl darunter.
aid-chart = Kurve
aid-chart_means = wie weit jede Spitze von ihrer Bahn entfernt ist. Ziehe daran, um zurückzuschauen.
aid-view = Rechte Taste, zwei Finger
aid-view_means = drehen die Ansicht. „Ansicht zurück“ stellt sie wieder her.
aid-search = Suche
aid-search_means = findet jede Einstellung, jeden Roboter, jede Regelung, Bahn, Lektion und Taste.
laws-own_heading = Eine eigene Regelung
lesson-done = fertig
lesson-begun = begonnen
lesson-begin_here = Hier geht es los
lesson-go_on_here = Hier geht es weiter
route-routes = Routen für einen Anlass
robots-differs_five_bar = zwei Motoren, starre Glieder
robots-differs_cart_pendulum = ein Pendel ohne Motor
robots-differs_hovercraft = kein Schub zur Seite
robots-differs_flexible = sein letztes Glied biegt sich
robots-differs_planar_arm = ein Motor mehr als nötig
robots-differs_rod_gantry = ein Stab ohne Motor
robots-differs_seven_axes = sieben Motoren, hält eine Haltung
robots-differs_spatial_arm = verlässt die Ebene
robots-differs_two_link_arm = Schulter und Ellbogen, gegen die Schwerkraft
keep-sharing = Teilen
keep-coming_back = Später weitermachen
keep-record = Bericht über meine Lektionen
compare-laws = Regelungen
compare-computing = Wird berechnet: { $done } von { $all } Regelungen
compare-put = Auf die Bühne
compare-put_left = Nach links
compare-put_right = Nach rechts
compare-on_left = links
compare-on_right = rechts
compare-on_both = auf beiden Seiten
compare-time = Zeit [s]
compare-curves = Abstand von der Bahn über der Zeit, wo jede Regelung am schlechtesten ist. Grau: Das Hindernis wirkt.
setup-draw = Zeichnen
setup-file = Datei…
setup-file_hint = Eine Zeichnung (SVG), Punkte (CSV) oder G-Code. Alle Linien werden nacheinander gezeichnet.

## Was an einem Roboter aus einer Datei geschätzt ist

guess-mark = geschätzt: { $kinds }
guess-next = { $listed }, { $other }
guess-last = { $listed } und { $other }
guess-mass = Masse
guess-inertia = Trägheit
guess-effort = Motorgrenzen
guess-tip = Endpunkt
guess-pose = Stellung
guess-told = { $what } ({ $line } legt es fest)

## Roboter, die durch einen Ordner oder ein Paket angegeben sind

robot_file-empty_folder = { $folder } enthält keine Roboterdatei ({ $endings })
robot_file-which_file = { $folder } enthält { $count } Roboterdateien. Bitte eine angeben: { $lines }
robot_file-not_fetched = robot_descriptions kann { $name } nicht laden: { $reason }
robot_file-no_description = { $name } aus robot_descriptions hat keine lesbare Datei

## Endpunkte, die die Datei eines Roboters nahelegt

robots-tip = Endpunkt { $tip }
robots-show_tips = Andere Endpunkte zeigen
robots-show_tips_hint = Kugeln in der Szene, mit Namen: die Glieder, die nach der Datei des Roboters sein Ende sein können. Ein Druck auf eine, und der Roboter wird mit ihr gebaut.
robots-build = Er wird gebaut, wenn man ihn wählt; das dauert einige Sekunden.
robots-no_such_tip = keine Datei dieses Labors legt diesen Endpunkt nahe
robots-waiting = Ein anderer Roboter wird gerade gebaut; danach kommt deiner …
robots-reading = { $file } wird mit dem Endpunkt { $tip } gelesen …
robots-shapes = Die Netze für den Endpunkt { $tip } werden gelesen …
robots-not_built = { $file } mit dem Endpunkt { $tip }: { $reason }. Der Roboter bleibt, wie er war
robots-not_read = sie konnte nicht gelesen werden ({ $reason })

## Eine Anlage anderswo, an der Stelle eines Roboters

plant-name = Anlage
plant-simulated = Simuliert
plant-law = Gesetz der Anlage
plant-law_simulated = Gesetz, simuliert
plant-start = START
plant-stop = STOPP
plant-stop_hint = Beendet es sofort. Taste: Esc
plant-start_hint = Startet den Regler. Der Arm bewegt sich, sobald sein Programm misst.
plant-at_fault = Drehmoment nach dem Ende
plant-zero = keines
plant-hold = das letzte
plant-damp = gegen die Bewegung
plant-off = Es ist nichts gestartet.
plant-starting = Der Regler wird erzeugt …
plant-waiting = Er wartet auf die Anlage an { $address }. Der Arm bewegt sich, sobald sein Programm misst.
plant-running = Es läuft.
plant-ended = Es ist beendet: { $cause }.
plant-sends = Die Anlage sendet noch; ihr Drehmoment jetzt: { $torque }. START geht wieder, wenn ihr Programm beendet ist.
plant-late = höchstens { $late } ms verspätet in der letzten Sekunde, { $latest } ms seit dem Start
plant-safety = Keine Sicherheitsfunktion. Um einen echten Arm gehören ein Not-Halt, der den Strom abschaltet, und die Grenzen des Herstellers; bleiben Sie außerhalb seiner Reichweite.
plant-watching = Diese Seite sieht zu; eine andere steuert.
plant-stopped = jemand hat STOPP gedrückt
plant-page_lost = die steuernde Seite ist weg oder im Hintergrund
plant-stood_still = das Lab stand eine Sekunde lang still
plant-failed = { $reason }
plant-cannot = Mit einem echten Arm geht das nicht.
