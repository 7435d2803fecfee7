/** Things taught side by side. */
import { screen, waitFor } from '@testing-library/react'
import { expect, it } from 'vitest'
import { server, show } from '../../../testing/page'
import { connectTeach } from '../../api/teaching'
import { useFits, type Compared } from './Comparison'

const FITS = 'GET /teach/fits'
const ABOVE: Compared = { key: 'joints above', label: 'above', arm: 'left', what: { kind: 'joints', name: 'above', capture: 0 } }

function Ends() {
  const { fits } = useFits([ABOVE])
  return <p role="status">{Object.values(fits).map((fit) => fit.primitive?.remark)}</p>
}

it('follow what somebody changes in the store meanwhile', async () => {
  server().on(FITS, { demonstration: null, primitive: { remark: 'slow' } })
  const disconnect = connectTeach()
  const socket = server().socket('/teach/live')
  socket.accept()
  show(<Ends />)
  await waitFor(() => expect(screen.getByRole('status')).toHaveTextContent('slow'))
  server().on(FITS, { demonstration: null, primitive: { remark: 'fast' } })
  socket.tell({ k: 'entries' })
  await waitFor(() => expect(screen.getByRole('status')).toHaveTextContent('fast'))
  disconnect()
})
