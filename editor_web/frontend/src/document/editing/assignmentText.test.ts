import { expect, test } from 'vitest'
import { assignedText, assignments } from './assignmentText'

test('assignments are the same when they are shown and read again', () => {
  const given = { count: '${count + 1}', last: 'good: really', number: 2.5, list: [1, 2] }
  expect(assignments(assignedText(given))).toEqual(given)
})

test('what is no mapping shows nothing, and a line without a value assigns an empty text', () => {
  expect(assignedText(undefined)).toBe('')
  expect(assignments('\n last \n')).toEqual({ last: '' })
})
