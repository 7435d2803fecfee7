/** Any value as a tree to unfold. */
import { screen } from '@testing-library/react'
import { expect, it } from 'vitest'
import { show } from '../../testing/page'
import { ValueTree } from './ValueTree'

it('stands on one line where it is short', () => {
  show(<ValueTree label="Value" value={[0.1, 0.2, 0.3]} />)
  expect(screen.getByRole('list', { name: 'Value' })).toHaveTextContent('[0.1, 0.2, 0.3]')
  expect(screen.queryByRole('button')).toBeNull()
})

it('unfolds part by part, and tells what is folded in short', async () => {
  const value = { header: { stamp: { sec: 12 }, frame: 'a name that is so long that nothing fits on one line with it' }, count: 3 }
  const user = show(<ValueTree label="Value" value={value} open={0} />)
  const fold = screen.getByRole('button', { name: /header/ })
  expect(fold).toHaveAttribute('aria-expanded', 'false')
  expect(screen.queryByText('stamp')).toBeNull()
  await user.click(fold)
  expect(fold).toHaveAttribute('aria-expanded', 'true')
  expect(screen.getByText('stamp')).toBeVisible()
  expect(screen.getByText('frame')).toBeVisible()
  await user.click(fold)
  expect(screen.queryByText('stamp')).toBeNull()
})
