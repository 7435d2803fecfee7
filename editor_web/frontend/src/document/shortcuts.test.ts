/** Keys. */
import { expect, it } from 'vitest'
import { SHORTCUTS, shortcutOf } from './shortcuts'

const plain = { ctrlKey: false, metaKey: false, altKey: false }

it('means one thing a key', () => {
  expect(new Set(SHORTCUTS.map((each) => each.key)).size).toBe(SHORTCUTS.length)
})

it('leaves the keys of the browser alone', () => {
  expect(shortcutOf({ ...plain, key: 'p' })).toBe('pause')
  expect(shortcutOf({ ...plain, key: 'p', ctrlKey: true })).toBeUndefined()
  expect(shortcutOf({ ...plain, key: 's' })).toBeUndefined()
})
