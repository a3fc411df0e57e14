// Where a student begins or goes on.

/** The first lesson that is not finished; one with a letter after its number may be skipped, and a test has no number. */
export function nextLesson<T extends { number: string; finished: boolean }>(lessons: readonly T[]): T | undefined {
    return lessons.find(({ number, finished }) => /^\d+$/.test(number) && !finished)
}
