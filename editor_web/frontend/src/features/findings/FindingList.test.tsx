/** The problems of a document: where each is, and what to do. */
import { screen } from '@testing-library/react'
import { expect, it, vi } from 'vitest'
import { show } from '../../../testing/page'
import type { FindingView } from '../../api/types'
import { FindingList } from './FindingList'

const UNKNOWN: FindingView = {
  severity: 'error',
  code: 'unknown-state',
  message: "no state is named 'motion.MoveJoint'",
  path: 'root/go',
  line: 14,
  column: 21,
  hint: 'did you mean motion.MoveJoints?',
}

it('names file, line, column and advice, and leads to the node', async () => {
  const chosen = vi.fn()
  const user = show(<FindingList document="behaviors/palletise.yaml" findings={[UNKNOWN]} onSelect={chosen} />)
  const finding = screen.getByRole('listitem')
  expect(finding).toHaveTextContent("error: no state is named 'motion.MoveJoint'")
  expect(finding).toHaveTextContent('did you mean motion.MoveJoints?')
  expect(finding).toHaveTextContent('palletise.yaml:14:21 · unknown-state')
  await user.click(screen.getByRole('button', { name: /^root\/go: no state is named/ }))
  expect(chosen.mock.calls).toEqual([['root/go']])
})

it('says that a document without problems can be run', () => {
  show(<FindingList document="behaviors/palletise.yaml" findings={[]} onSelect={() => undefined} />)
  expect(screen.getByText('No problems')).toBeVisible()
  expect(screen.getByText('The document can be run.')).toBeVisible()
})
