/** Values of two runs beside one another. */
import type { ValueChange } from '../../api/types'
import styles from './comparison.module.css'

export function DifferenceTable({ rows, name }: { readonly rows: readonly ValueChange[]; readonly name: string }) {
  return (
    <table className={styles.table}>
      <thead>
        <tr>
          <th scope="col">{name}</th>
          <th scope="col">Left</th>
          <th scope="col">Right</th>
        </tr>
      </thead>
      <tbody>
        {rows.map((each) => (
          <tr key={each.at}>
            <th scope="row">{each.at}</th>
            <Value text={each.left} />
            <Value text={each.right} />
          </tr>
        ))}
      </tbody>
    </table>
  )
}

function Value({ text }: { readonly text: string | null }) {
  return <td className={text === null ? styles.missing : styles.value}>{text ?? 'nothing'}</td>
}
