/** Measuring from one item to the selected one. */
import { screen } from '@testing-library/react'
import { expect, it, vi } from 'vitest'
import { show } from '../../../testing/page'
import { turnOf } from '../../document/poses'
import { Measure, type MeasuredItem } from './Measure'

const TABLE: MeasuredItem = { address: 'fixtures/table', name: 'table', pose: { xyz: [0, 0, 0], xyzw: [0, 0, 0, 1] } }
const PLATE: MeasuredItem = { address: 'parts/plate', name: 'plate', pose: { xyz: [0.3, 0.4, 0], xyzw: turnOf([0, 0, 0.1]) } }

it('begins at what is selected, if that has a place', async () => {
  const onFrom = vi.fn()
  const user = show(<Measure from={undefined} to={TABLE} onFrom={onFrom} />)
  await user.click(screen.getByRole('button', { name: 'Measure from here' }))
  expect(onFrom).toHaveBeenCalledExactlyOnceWith('fixtures/table')
})

it('cannot begin at what has no place', () => {
  show(<Measure from={undefined} to={undefined} onFrom={vi.fn()} />)
  expect(screen.getByRole('button', { name: 'Measure from here' })).toBeDisabled()
})

it('tells distance, parts and angle to another item, and ends', async () => {
  const onFrom = vi.fn()
  const user = show(<Measure from={TABLE} to={PLATE} onFrom={onFrom} />)
  const rows = screen.getAllByRole('row').map((row) => row.textContent)
  expect(rows).toEqual(['Distance0.5000 m', 'In the world0.300, 0.400, 0.000 m', 'Along table0.300, 0.400, 0.000 m', 'Angle5.73°'])
  await user.click(screen.getByRole('button', { name: 'End measuring' }))
  expect(onFrom).toHaveBeenCalledExactlyOnceWith('')
})

it('asks for a second item', () => {
  show(<Measure from={TABLE} to={TABLE} onFrom={vi.fn()} />)
  expect(screen.getByText('From table: select another item')).toBeVisible()
})
