/** Who commands which resource, from which node and with which goal, and since when. */
import { IconLockOpen } from '@tabler/icons-react'
import { Empty } from '../../components/Empty'
import { duration } from '../../document/time'
import { holderText } from './words'
import type { GoalInfo, LeaseMetrics } from '../../api/types'

interface LeasesProps {
  readonly leases: readonly LeaseMetrics[]
  readonly goals: readonly GoalInfo[]
  readonly search: string
}

export function Leases({ leases, goals, search }: LeasesProps) {
  const shown = leases.filter((each) => `${each.resource} ${each.run} ${each.node}`.toLowerCase().includes(search.toLowerCase()))
  if (shown.length === 0) {
    return (
      <Empty icon={<IconLockOpen size={26} stroke={1.4} aria-hidden />} title={leases.length > 0 ? 'Nothing matches' : 'No leases'}>
        {leases.length > 0 ? 'Clear the search.' : 'A run takes an arm or gripper when it first commands it, and keeps it to its end.'}
      </Empty>
    )
  }
  return (
    <div className="lease-scroll" tabIndex={0} role="region" aria-label="Resource leases">
      <table className="lease-table">
        <thead>
          <tr>
            <th scope="col">Resource</th>
            <th scope="col">Held by</th>
            <th scope="col">Node</th>
            <th scope="col">Goal</th>
            <th scope="col">For</th>
          </tr>
        </thead>
        <tbody>
          {shown.map((lease) => (
            <tr key={lease.resource}>
              <td className="mono">{lease.resource}</td>
              <td>{holderText(lease.run)}</td>
              <td className="mono">{lease.node || <span className="quiet">kept by the run</span>}</td>
              <td className="mono">{goalText(lease, goals)}</td>
              <td className="lease-time">{duration(lease.held_s)}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  )
}

function goalText(lease: LeaseMetrics, goals: readonly GoalInfo[]): string {
  const goal = goals.find((each) => each.id === lease.goal)
  return goal ? `${goal.address} (${goal.status})` : '–'
}
