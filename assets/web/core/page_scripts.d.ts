// What scripts of assets/page, which come before ours in the lab's page, leave for it: browser_words.js and quality.js.

declare const ownWords: { text(): Record<string, string>; language(): string }
declare const webgl: { works: boolean; plain: boolean }
